// The processes of one simulated host, of all its programs: their numbers, signals between them,
// and who waits.
//
//   HostProcesses processes;
//   const int number = processes.take_number();
//   if (Process* target = processes.find(100)) print(target->number());
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace simbench::sim {

class Process;
struct ProgramThread;

class HostProcesses {
 public:
  // Threads and processes together.
  static constexpr std::size_t kMost = 64;
  static constexpr std::int32_t kFirstNumber = 100;  // of the programs' own; then those they start

  std::int32_t next_number() const { return next_; }
  std::int32_t take_number() { return next_++; }
  void add(Process& process) { all_.push_back(&process); }
  void remove(const Process& process);
  // Null: there is none.
  Process* find(std::int32_t number) const;
  Process* find_machine(pid_t machine) const;
  const std::vector<Process*>& all() const { return all_; }

  void add_thread(ProgramThread& thread) { threads_.push_back(&thread); }
  void remove_thread(const ProgramThread& thread);
  std::size_t threads() const { return threads_.size(); }

  // What threads do to each other over what is real: counted, and told to those that watch it.
  void report_activity();
  std::uint64_t activity() const { return activity_; }
  // Whether a thread waits for it.
  bool has_watchers() const;

  // The place of a thread among those that wait for a lock.
  std::uint64_t take_order() { return ++order_; }

 private:
  std::vector<Process*> all_{};
  std::vector<ProgramThread*> threads_{};
  std::int32_t next_ = kFirstNumber;
  std::uint64_t activity_ = 0;
  std::uint64_t order_ = 0;
};

}  // namespace simbench::sim
