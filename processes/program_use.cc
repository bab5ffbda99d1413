#include "processes/program_use.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>
#include <vector>

#include "processes/process_tree.h"

namespace simbench::processes {

const ControlGroup& RunUse::group() {
  if (!group_) group_.emplace(ControlGroup::Limits{most_memory_, kMostProcesses});
  return *group_;
}

std::string RunUse::memory_excess() const {
  return fmt::format("used more than {} MiB of memory, with the run's other programs",
                     most_memory_ >> 20U);
}

ProgramUse::ProgramUse(int folder, pid_t ancestor, const FolderLimits& limits,
                       std::shared_ptr<RunUse> run)
    : folder_(folder), ancestor_(ancestor), limits_(limits), run_(std::move(run)) {}

ProgramUse::~ProgramUse() {
  run_->change_memory(counted_, 0);
  close(folder_);
}

std::string ProgramUse::excess() {
  FolderUse disk = folder_use(folder_, limits_);
  std::uint64_t memory = 0;
  for (const pid_t each : descendants(ancestor_)) {
    add_unlinked_files(each, disk);
    memory += resident_bytes(each);
  }
  run_->change_memory(counted_, memory);
  counted_ = memory;
  if (std::string excess = excess_of(disk, limits_); !excess.empty()) return excess;
  return run_->memory() > run_->most_memory() ? run_->memory_excess() : "";
}

std::string ProgramUse::excess_of_killed() const {
  return run_->group().has_run_out() ? run_->memory_excess() : "";
}

}  // namespace simbench::processes
