#include "processes/program_use.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "processes/process_tree.h"

namespace simbench::processes {

ProgramUse::ProgramUse(int folder, const FolderLimits& limits, std::shared_ptr<RunMemory> memory)
    : folder_(folder), limits_(limits), memory_(std::move(memory)) {}

ProgramUse::~ProgramUse() { memory_->used -= counted_; }

std::string ProgramUse::excess(pid_t ancestor) {
  FolderUse disk = folder_use(folder_, limits_);
  std::uint64_t memory = 0;
  for (const pid_t each : descendants(ancestor)) {
    add_unlinked_files(each, disk);
    memory += resident_bytes(each);
  }
  memory_->used += memory - std::exchange(counted_, memory);
  if (std::string excess = excess_of(disk, limits_); !excess.empty()) return excess;
  if (memory_->used <= memory_->limit) return "";
  return fmt::format("used more than {} MiB of memory, with the run's other programs",
                     memory_->limit >> 20U);
}

}  // namespace simbench::processes
