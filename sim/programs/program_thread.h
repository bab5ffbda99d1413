// A thread of a simulated program: its link, and what it waits for.
//
//   Task<void> wait(SimHost& host, Process& process) {
//     ProgramThread thread(host, process, 100, nullptr);
//     co_await thread.woken.wait(std::nullopt);
//   }
#pragma once

#include <fmt/format.h>
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "processes/child.h"
#include "shim/protocol.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

class Process;

struct ProgramThread {
  // A wait for a place in memory.
  struct LockWait {
    shim::Lock lock{};
    std::uint64_t order = 0;  // of those that wait for it, the lowest is woken first
    bool is_woken = false;
  };

  ProgramThread(SimHost& host, Process& of, std::int32_t thread_number,
                std::unique_ptr<processes::Child> own_end)
      : process(&of),
        number(thread_number),
        end(std::move(own_end)),
        woken(host.world().context, host.name(fmt::format("program {} waits", thread_number))) {}

  Process* process;
  std::int32_t number;
  std::unique_ptr<processes::Child> end;  // the world's, of its link
  WaitPoint woken;
  pid_t machine = -1;  // what the machine calls it, as it says itself
  std::uint64_t signals_seen = 0;
  std::optional<LockWait> lock_wait{};
  bool watches_real = false;  // in its present wait
  bool has_left = false;      // it said so
};

}  // namespace simbench::sim
