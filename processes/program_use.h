// What a program and all that it started use: of memory, together with the run's other programs,
// and of the disk.
//
// Memory is counted when a program is looked at; of those that wait, what they had then. Only one
// runs at a time, so the sum is passed by no more than that one may have (Child::kMostMemory).
// Where there is a control group (processes/control_group.h), the kernel counts too.
//
//   auto run = std::make_shared<RunUse>();
//   ProgramUse use(open_folder_in(AT_FDCWD, "world/host0"), getpid(), {}, run);
//   print(use.excess());  // "made more than 4096 files"
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "processes/control_group.h"
#include "processes/folder_use.h"

namespace simbench::processes {

// What all programs of a run have together; for one thread.
class RunUse {
 public:
  // Some 400 Python programs, or 1000 daemons.
  static constexpr std::uint64_t kMostMemory = std::uint64_t{4} << 30;
  static constexpr std::size_t kMostProcesses = 4096;

  explicit RunUse(std::uint64_t most_memory = kMostMemory) : most_memory_(most_memory) {}

  std::uint64_t most_memory() const { return most_memory_; }
  std::uint64_t memory() const { return memory_; }
  void change_memory(std::uint64_t from, std::uint64_t to) { memory_ += to - from; }
  // The run's, which is made when it is first asked for.
  const ControlGroup& group();
  // What is said of who has passed the limit of the memory.
  std::string memory_excess() const;

 private:
  std::uint64_t most_memory_;
  std::uint64_t memory_ = 0;
  std::optional<ControlGroup> group_;
};

class ProgramUse {
 public:
  // `folder` is a descriptor, which is closed with this. `ancestor` is the parent of all of the
  // program's processes.
  ProgramUse(int folder, pid_t ancestor, const FolderLimits& limits, std::shared_ptr<RunUse> run);
  ~ProgramUse();
  ProgramUse(const ProgramUse&) = delete;
  ProgramUse& operator=(const ProgramUse&) = delete;

  // What has passed a limit, as the end of a sentence; empty: nothing.
  std::string excess();
  // The limit for which the kernel has killed it; empty: it was not for a limit.
  std::string excess_of_killed() const;

 private:
  int folder_;
  pid_t ancestor_;
  FolderLimits limits_;
  std::shared_ptr<RunUse> run_;
  std::uint64_t counted_ = 0;  // of the memory
};

}  // namespace simbench::processes
