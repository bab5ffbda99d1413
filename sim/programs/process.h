// A process as the world has it: what its descriptors stand for, and its requests about them and
// about clocks (shim/protocol.h), each an await on the host's ports.
//
// What takes time is what the ports say takes time: readings and settings of the clock, sends,
// wake-ups. Requests are not trusted: one that is no request throws BadRequest, which ends the
// program (sim/programs/program.h).
//
// Clocks: CLOCK_REALTIME and its kin are the host's system clock, all monotonic ones its oscillator
// (which the kernel's rate corrections do not touch, unlike Linux'), CPU clocks likewise; the
// network card's has no number of its own (shim::kCardClock).
//
// A forked process has its parent's descriptors; the objects are shared and end with the last.
//
// A timer that makes a signal ends a wait; one that expires while the program computes is told with
// the reply to what it asks next. A process that asks more than kMostASecond times within a second
// of simulated time is ended.
//
//   Task<void> read_clock(SimHost& host, const Process::Surroundings& surroundings) {
//     Process process(surroundings, 100, 1);
//     ProgramThread thread(host, process, 100, nullptr);
//     ChildRequest request{.head = {.call = shim::Call::kReadClock}};
//     const Process::Answer answer = co_await process.answer(thread, std::move(request));
//   }
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
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
#include "sim/programs/host_files.h"
#include "sim/programs/host_network.h"
#include "sim/programs/host_processes.h"
#include "sim/programs/host_streams.h"
#include "sim/programs/kernel_clock.h"
#include "sim/programs/open_object.h"
#include "sim/programs/process_timers.h"
#include "sim/programs/pulse_devices.h"

namespace simbench::sim {

// A process's requests are of the room that the real world shares.
using processes::BadRequest;
using processes::bytes_of;
using processes::Child;
using processes::ChildRequest;
using processes::kMostOpen;
using processes::read_head;

struct ProgramThread;

// How a wait ended.
enum class WaitEnd { kReady, kTimeUp, kSignal, kActivity };

class Process {
 public:
  static constexpr std::uint64_t kMostASecond = 50'000;

  // What belongs to the host and the program; it must outlive the process.
  struct Surroundings {
    SimHost& host;
    HostNetwork& network;
    KernelClock& kernel;
    CardClock& card;
    PulseDevices& pulses;
    HostProcesses& processes;
    HostFiles& files;
    RandomStream& chance;
    std::function<void()> wake;  // the program's threads look again
  };

  struct Answer {
    std::int64_t value = 0;
    int error = 0;
    Bytes data{};
  };

  Process(const Surroundings& surroundings, std::int32_t number, std::int32_t parent);
  // A forked one.
  Process(const Process& parent, std::int32_t number);
  ~Process();
  Process& operator=(const Process&) = delete;

  std::int32_t number() const { return number_; }
  std::int32_t parent() const { return parent_; }
  void set_parent(std::int32_t parent) { parent_ = parent; }
  // What the machine calls it; -1: not known yet. The kernel is asked for a handle, by which it is
  // signalled and awaited; the number of one that was started elsewhere stays its own.
  pid_t machine() const { return machine_; }
  void set_machine(pid_t machine);
  // By the machine, as from that process; returns an errno. Its threads look at it in their waits.
  int signal(int number, std::int32_t sender = 1, std::optional<std::uint64_t> value = {});
  void look_at_signals();
  std::uint64_t signals() const { return signals_; }
  // After the last thread: waits until the machine knows that it has ended, for a moment.
  void await_end() const;

  // Throws for a process that asks too often.
  void count_request();
  // These throw for what is no request.
  Task<Answer> answer(ProgramThread& thread, ChildRequest request);
  shim::Identity identity(const ProgramThread& thread) const;
  // After exec(): closes all descriptors but these.
  Task<void> keep_only(const Bytes& numbers);
  Task<void> close_all();
  // Whether a signal timer has expired that the program has not heard of.
  bool has_expirations();
  // Until it is ready, the deadline has come, there is a signal, or, if asked for, activity.
  Task<WaitEnd> wait_until(ProgramThread& thread, WakeTime deadline, bool watches_real,
                           std::function<bool()> is_ready,
                           std::function<std::optional<TrueTime>()> next_look);
  Task<Answer> wait_for_wake(ProgramThread& thread, const ChildRequest& request);
  void stop() { is_stopped_ = true; }

  bool is_replaced = false;  // a thread of it is about to become another program
  bool has_ended = false;

 private:
  Answer random_bytes(std::int64_t count);
  Answer look_at_file(const ChildRequest& request);
  Task<Answer> read_clock(std::int64_t clock, bool is_free);
  Task<Answer> set_clock(std::int64_t clock, std::int64_t reading);
  Task<Answer> adjust_clock(ChildRequest request);

  // Null if there is none.
  std::shared_ptr<OpenObject> object_of(int fd) const;
  std::shared_ptr<OpenObject> open(int fd, OpenObject::What what);
  Task<Answer> close(int fd);
  UdpSocket& socket_of(int fd);
  Answer open_socket(const ChildRequest& request);
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
  std::shared_ptr<OpenObject> add_stream(int fd, std::shared_ptr<StreamSocket> stream);

  Answer open_timer(int fd, std::int64_t clock);
  Answer of_timer(const ChildRequest& request);
  Answer of_signal_timer(const ChildRequest& request);
  Answer take_expirations();
  static bool is_about_devices(shim::Call call);
  Answer of_device(const ChildRequest& request);
  Answer open_device(int fd, std::int64_t which);
  Answer of_card(const DeviceFile& file, const ChildRequest& request);

  Answer open_set(int fd);
  Answer control_set(const ChildRequest& request);
  Answer take_events(const ChildRequest& request);

  Task<Answer> wait(ProgramThread& thread, ChildRequest request);
  std::int16_t readiness_of(const shim::Interest& interest);
  std::optional<TrueTime> next_timer(std::span<const shim::Interest> interests);

  Surroundings around_;
  std::int32_t number_;
  std::int32_t parent_;
  pid_t machine_ = -1;
  int handle_ = -1;  // pidfd; -1: none
  std::uint64_t signals_ = 0;
  std::map<int, std::shared_ptr<OpenObject>> open_{};  // by the shim's number
  std::map<int, ProcessTimer> signal_timers_{};        // by the shim's number
  bool is_stopped_ = false;
  TrueTime counted_since_;
  std::uint64_t asked_ = 0;
};

}  // namespace simbench::sim
