// What a program and all that it started use: of memory, together with the run's other programs,
// and of the disk.
//
// Memory is counted when a program is looked at; of those that wait, what they had then. Only one
// runs at a time, so the sum is passed by no more than that one may have (Child::kMostMemory).
//
//   auto memory = std::make_shared<RunMemory>();
//   ProgramUse use(folder, {}, memory);
//   print(use.excess(4711));  // "made more than 4096 files"
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>

#include "processes/folder_use.h"

namespace simbench::processes {

// What all programs of a run have; for one thread.
struct RunMemory {
  // Some 400 Python programs, or 1000 daemons.
  std::uint64_t limit = std::uint64_t{4} << 30;
  std::uint64_t used = 0;
};

class ProgramUse {
 public:
  // `folder` is a descriptor, which stays the caller's and open.
  ProgramUse(int folder, const FolderLimits& limits, std::shared_ptr<RunMemory> memory);
  ~ProgramUse();
  ProgramUse(const ProgramUse&) = delete;
  ProgramUse& operator=(const ProgramUse&) = delete;

  // What has passed a limit, as the end of a sentence; empty: nothing. `ancestor` is the parent of
  // all of the program's processes.
  std::string excess(pid_t ancestor);

 private:
  int folder_;
  FolderLimits limits_;
  std::shared_ptr<RunMemory> memory_;
  std::uint64_t counted_ = 0;  // of the memory
};

}  // namespace simbench::processes
