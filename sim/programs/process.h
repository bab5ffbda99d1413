// A process as the world has it: its requests (shim/protocol.h), each an await on the host's ports.
//
// serve() runs the program until it ends or the world does. While the program computes, no time
// passes; what takes time is what the ports say takes time: readings and settings of the clock,
// sends, wake-ups. Requests are not trusted: one that is no request ends the program, with a note.
//
// Clocks: CLOCK_REALTIME and its kin are the host's system clock, all monotonic ones its oscillator
// (which the kernel's rate corrections do not touch, unlike Linux'), CPU clocks likewise; the
// network card's has no number of its own (shim::kCardClock).
//
// Programs of a host may speak over real sockets (Unix-domain): who waits for one looks again
// whenever another says that it did something there, or has ended.
//
// A wait for a system time looks at least every second whether the clock was set. A program that
// asks kMostAtOnce times without waiting is ended.
//
//   HostNetwork network(host, 6);
//   KernelClock kernel(host);
//   CardClock card(host);
//   Process process(host, network, kernel, card, {.command = {"/usr/sbin/chronyd", "-d"}}, 1);
//   boost::asio::co_spawn(context, process.serve(), boost::asio::detached);
#ifndef SIMBENCH_SIM_PROGRAMS_PROCESS_H_
#define SIMBENCH_SIM_PROGRAMS_PROCESS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "shim/protocol.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/programs/card_clock.h"
#include "sim/programs/child.h"
#include "sim/programs/host_network.h"
#include "sim/programs/host_streams.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {

class Process {
 public:
  static constexpr std::uint64_t kMostAtOnce = 50'000;

  // `number` tells the processes of a host apart. The references must outlive this.
  Process(SimHost& host, HostNetwork& network, KernelClock& kernel, CardClock& card,
          const Child::Settings& settings, std::uint32_t number);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Ends with the program.
  Task<void> serve();
  // Why it ended, one line; empty while it runs.
  const std::string& ending() const { return ending_; }

 private:
  struct Answer {
    std::int64_t value = 0;
    int error = 0;
    Bytes data{};
  };
  struct Timer {
    bool is_system = false;  // follows the system clock
    std::int64_t next = 0;   // on its clock, ns; 0: disarmed
    std::int64_t interval = 0;
    std::int64_t expirations = 0;
  };

  // Throws for a program that asks too often.
  void count_request(shim::Call call);
  // These throw for what is no request.
  Task<Answer> answer(ChildRequest request);
  shim::Identity identity() const;
  Answer random_bytes(std::int64_t count);
  Task<Answer> read_clock(std::int64_t clock);
  Task<Answer> set_clock(std::int64_t clock, std::int64_t reading);
  Task<Answer> adjust_clock(ChildRequest request);

  UdpSocket& socket_of(int fd);
  Answer open_socket(int fd, std::int64_t type);
  Answer close(int fd);
  Answer of_socket(const ChildRequest& request);
  Task<Answer> read_card(std::int64_t count);
  Answer card_stamping(std::int64_t wanted);
  int join(UdpSocket& socket, bool joins, std::int64_t group);
  static Answer set_option(UdpSocket& socket, shim::SocketOption option, std::int64_t value);
  static Answer receive(UdpSocket& socket, std::int64_t how);
  Task<Answer> send(ChildRequest request);

  bool is_of_stream(const ChildRequest& request) const;
  Answer open_stream(int fd);
  Task<Answer> of_stream(ChildRequest request);
  Answer accept(Stream& listener, std::int64_t fd);
  Task<Answer> write(Stream& stream, const Bytes& data);
  Task<Answer> read(Stream& stream, std::int64_t how, std::int64_t most);
  static Answer describe(Stream& stream, shim::Call call);
  Task<void> close_streams();
  void close_sockets();
  std::size_t open_descriptors() const {
    return sockets_.size() + streams_.size() + timers_.size();
  }

  Answer open_timer(int fd, std::int64_t clock);
  Answer of_timer(const ChildRequest& request);
  std::int64_t now_of(const Timer& timer) const;
  // Counts what has expired until now.
  void expire(Timer& timer) const;

  Task<Answer> wait(ChildRequest request);
  std::int16_t readiness(const shim::Interest& interest);
  bool is_past(shim::Deadline kind, std::int64_t at) const;
  // When to look at the clock again; nothing: never.
  std::optional<TrueTime> next_look(shim::Deadline kind, std::int64_t at) const;
  std::optional<TrueTime> look_at_system_time(std::int64_t at) const;
  std::optional<TrueTime> next_timer(std::span<const shim::Interest> interests);

  SimHost& host_;
  HostNetwork& network_;
  KernelClock& kernel_;
  CardClock& card_;
  std::uint32_t number_;
  RandomStream chance_;
  WaitPoint woken_;
  std::map<int, UdpSocket> sockets_;
  std::map<int, std::shared_ptr<Stream>> streams_;
  std::map<int, Timer> timers_;
  Child child_;
  std::string ending_;
  TrueTime waited_{};
  std::uint64_t asked_at_once_ = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_PROCESS_H_
