#include "sim/programs/host_processes.h"

#include <algorithm>

#include "sim/programs/process.h"
#include "sim/programs/program_thread.h"

namespace simbench::sim {

void HostProcesses::remove(const Process& process) { std::erase(all_, &process); }

Process* HostProcesses::find(std::int32_t number) const {
  const auto found = std::ranges::find(all_, number, &Process::number);
  return found != all_.end() ? *found : nullptr;
}

Process* HostProcesses::find_machine(pid_t machine) const {
  const auto found = std::ranges::find(all_, machine, &Process::machine);
  return found != all_.end() ? *found : nullptr;
}

void HostProcesses::remove_thread(const ProgramThread& thread) { std::erase(threads_, &thread); }

void HostProcesses::report_activity() {
  ++activity_;
  for (ProgramThread* each : threads_) {
    if (each->watches_real) each->woken.notify();
  }
}

bool HostProcesses::has_watchers() const {
  return std::ranges::any_of(threads_, &ProgramThread::watches_real);
}

}  // namespace simbench::sim
