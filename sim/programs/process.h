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
// A timer that makes a signal ends a wait; one that expires while the program computes is told with
// the reply to what it asks next. A program that asks more than kMostASecond times within a second
// of simulated time is ended.
//
//   HostNetwork network(host, 6);
//   KernelClock kernel(host);
//   CardClock card(host);
//   Process process(host, network, kernel, card, {.command = {"/usr/sbin/chronyd", "-d"}}, 1);
//   boost::asio::co_spawn(context, process.serve(), boost::asio::detached);
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "processes/child.h"
#include "processes/requests.h"
#include "shim/protocol.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/programs/card_clock.h"
#include "sim/programs/host_network.h"
#include "sim/programs/host_streams.h"
#include "sim/programs/kernel_clock.h"
#include "sim/programs/process_timers.h"

namespace simbench::sim {

// A process's requests are of the room that the real world shares.
using processes::BadRequest;
using processes::bytes_of;
using processes::Child;
using processes::ChildRequest;
using processes::kMostOpen;
using processes::read_head;

class Process {
 public:
  static constexpr std::uint64_t kMostASecond = 50'000;

  // `number` tells the processes of a host apart. The references must outlive this.
  Process(SimHost& host, HostNetwork& network, KernelClock& kernel, CardClock& card,
          const Child::Settings& settings, std::uint32_t number);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Ends with the program.
  Task<void> serve();
  // Ends it at its next wait, or the one that it is in.
  void stop();
  // Why it ended by itself, one line; empty while it runs, and once it is stopped.
  const std::string& ending() const { return ending_; }

 private:
  struct Answer {
    std::int64_t value = 0;
    int error = 0;
    Bytes data{};
  };
  // Throws for a program that asks too often.
  void count_request();
  // These throw for what is no request.
  Task<Answer> answer(ChildRequest request);
  shim::Identity identity() const;
  Answer random_bytes(std::int64_t count);
  Task<Answer> read_clock(std::int64_t clock);
  Task<Answer> set_clock(std::int64_t clock, std::int64_t reading);
  Task<Answer> adjust_clock(ChildRequest request);

  UdpSocket& socket_of(int fd);
  Answer open_socket(const ChildRequest& request);
  Answer close(int fd);
  Answer of_socket(const ChildRequest& request);
  Task<Answer> read_card(std::int64_t count);
  Answer card_stamping(std::int64_t wanted);
  static int set_filter(UdpSocket& socket, const Bytes& data);
  static Answer receive(UdpSocket& socket, std::int64_t how);
  Task<Answer> send(ChildRequest request);

  bool is_of_stream(const ChildRequest& request) const;
  Answer open_stream(int fd, int family);
  Task<Answer> of_stream(ChildRequest request);
  Answer accept(StreamSocket& listener, std::int64_t fd);
  Task<Answer> write(StreamSocket& stream, const Bytes& data);
  Task<Answer> read(StreamSocket& stream, std::int64_t how, std::int64_t most);
  static int set_stream_option(StreamSocket& stream, std::int64_t option, std::int64_t value);
  static Answer describe(StreamSocket& stream, shim::Call call);
  Task<void> close_streams();
  void close_sockets();
  std::size_t open_descriptors() const {
    return sockets_.size() + streams_.size() + timers_.size();
  }

  Answer open_timer(int fd, std::int64_t clock);
  Answer of_timer(const ChildRequest& request);
  Answer of_signal_timer(const ChildRequest& request);
  Answer take_expirations();
  // Whether a signal timer has expired that the program has not heard of.
  bool has_expirations();

  Task<Answer> wait(ChildRequest request);
  std::int16_t readiness(const shim::Interest& interest);
  std::optional<TrueTime> next_timer(std::span<const shim::Interest> interests);

  SimHost& host_;
  HostNetwork& network_;
  KernelClock& kernel_;
  CardClock& card_;
  std::uint32_t number_;
  RandomStream chance_;
  WaitPoint woken_;
  std::map<int, UdpSocket> sockets_;
  std::map<int, std::shared_ptr<StreamSocket>> streams_;
  std::map<int, ProcessTimer> timers_;         // by descriptor
  std::map<int, ProcessTimer> signal_timers_;  // by the shim's number
  Child child_;
  std::string ending_;
  bool is_stopped_ = false;
  TrueTime counted_since_;
  std::uint64_t asked_ = 0;
};

}  // namespace simbench::sim
