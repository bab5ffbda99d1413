// A program of a simulated host: its processes and their threads, each a link to the world
// (shim/protocol.h).
//
// serve() runs the program until its last process has ended or the world does. One thread computes
// at a time, of all programs: while it does, no time passes, and the others are stopped at their
// requests. A thread hands over when it asks for something that takes time; who goes on next is
// decided by the events of the world, so that the same scenario and seed give the same bytes
// whatever the machine does. A new thread or process begins when its maker has handed over.
//
// Threads and processes of a host may speak over real descriptors (pipes, Unix-domain sockets): who
// waits for one looks again whenever another of its program has asked for something, another
// program says that it did something there, or one has ended. Locks in memory that processes share
// wake all that wait for such a lock. A thread that waits for the machine itself (a lock of a file,
// stdio's read of a pipe) is found asleep, and goes on beside others once they have made it ready:
// there alone the order of two threads is the machine's.
//
// A request that is none, or a program that says what it cannot have (kNote), ends all of the
// program, with a note. At most HostProcesses::kMost threads and processes are on a host; fork()
// and pthread_create() then fail with EAGAIN.
//
//   void run(const Program::Surroundings& surroundings, VirtualContext& context) {
//     Program program(surroundings, {.command = {"/usr/sbin/chronyd", "-d"}});
//     boost::asio::co_spawn(context, program.serve(), boost::asio::detached);
//   }
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "processes/child.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/programs/card_clock.h"
#include "sim/programs/host_files.h"
#include "sim/programs/host_network.h"
#include "sim/programs/host_processes.h"
#include "sim/programs/kernel_clock.h"
#include "sim/programs/process.h"
#include "sim/programs/program_thread.h"
#include "sim/programs/pulse_devices.h"

namespace simbench::sim {

class Program {
 public:
  static constexpr int kMostMade = 2000;

  // What belongs to the host; it must outlive the program.
  struct Surroundings {
    SimHost& host;
    HostNetwork& network;
    KernelClock& kernel;
    CardClock& card;
    PulseDevices& pulses;
    HostProcesses& processes;
    HostFiles& files;
  };

  Program(const Surroundings& surroundings, const Child::Settings& settings);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Ends with the program.
  Task<void> serve();
  // Ends it at its next wait, or the one that it is in.
  void stop();
  // Why it ended by itself, one line; empty while it runs, and once it is stopped.
  const std::string& ending() const { return ending_; }
  // That ending in its parts.
  const processes::ProgramEnd& end() const { return end_; }

 private:
  using Answer = Process::Answer;

  Process::Surroundings for_processes();
  ProgramThread& add_thread(Process& process, std::int32_t number, std::unique_ptr<Child> end);
  std::optional<ChildRequest> next(ProgramThread& thread);
  void reply(ProgramThread& thread, const Answer& answer);
  Child& end_of(ProgramThread& thread);
  Task<void> wait_for_activity(ProgramThread& thread);
  // Until the thread, its process or the program has ended.
  Task<void> run(ProgramThread& thread);
  bool goes_on(const ProgramThread& thread) const;
  Task<void> leave(ProgramThread& thread);
  Task<void> end_process(Process& process);
  void fail(const std::string& reason);
  void wake_threads();

  // These throw for what is no request.
  Task<Answer> answer(ProgramThread& thread, ChildRequest request);
  void count_made();
  Task<Answer> announce(ProgramThread& maker, ChildRequest request);
  Answer start(const ChildRequest& request);
  Task<Answer> hello(ProgramThread& thread, ChildRequest request);
  Answer send_signal(const ProgramThread& sender, const ChildRequest& request);
  Answer find_process(const shim::Request& request) const;
  Answer wake_waiting(const ProgramThread& waker, const ChildRequest& request);
  Answer requeue(const ProgramThread& waker, const ChildRequest& request);
  // All of a process, or all of the others that share the lock.
  void wake_locks(const Process& process);
  // The threads that wait for the lock, the one that came first at the beginning.
  std::vector<ProgramThread*> waiting_for(const Process& process, const shim::Lock& lock);

  Surroundings around_;
  RandomStream chance_;
  WaitPoint has_ended_;
  Child child_;
  std::list<Process> processes_{};
  std::list<ProgramThread> threads_{};
  std::string reason_;
  std::string ending_;
  processes::ProgramEnd end_;
  TrueTime counted_since_;
  int made_ = 0;
  bool is_over_ = false;
  bool is_stopped_ = false;
};

}  // namespace simbench::sim
