// What adjtimex() does, on a simulated host's system clock (clocks/kernel_discipline.h).
//
// One for each host, shared by its programs, as the kernel's is. Calls that change the clock take
// the time that the scenario says, what the kernel does by itself takes none.
//
//   KernelClock kernel(host);
//   boost::asio::co_spawn(context, kernel.run(), boost::asio::detached);
//   timex request{};
//   request.modes = ADJ_FREQUENCY;
//   request.freq = 65536 * 12;  // 12 ppm
//   const KernelClock::Answer answer = co_await kernel.adjust(request);
#pragma once

#include <sys/timex.h>

#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"
#include "clocks/kernel_discipline.h"
#include "shim/protocol.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

// The system clocks of the simulated world begin at 0; those of its programs at this time, the
// beginning of 2028, since some refuse earlier ones.
inline constexpr std::int64_t kEpochNs = shim::kWorldBegin;

constexpr std::int64_t epoch_ns(HostTime time) { return nanoseconds_of(time) + kEpochNs; }
constexpr HostTime from_epoch_ns(std::int64_t ns) { return HostTime(Nanoseconds(ns - kEpochNs)); }

// The oscillators of the simulated world may read less than 0 when a run begins; the monotonic
// clocks of its programs are ahead of them by this much, since Linux' never do.
inline constexpr std::int64_t kBootNs = 2'000'000 * kSecondNs;

constexpr std::int64_t monotonic_ns(SteadyTime time) { return nanoseconds_of(time) + kBootNs; }
constexpr SteadyTime from_monotonic_ns(std::int64_t ns) {
  return SteadyTime(Nanoseconds(ns - kBootNs));
}

class KernelClock {
 public:
  struct Answer {
    int state = TIME_OK;
    int error = 0;  // an errno
    timex now{};    // what adjtimex() fills in
  };

  // The host must outlive this.
  explicit KernelClock(SimHost& host);

  // The kernel's own work, for ever: without it nothing is added to the phase. It costs an event a
  // second while there is something to add or a leap second ahead, else none.
  Task<void> run();

  Task<Answer> adjust(timex request);
  // clock_settime().
  Task<void> set(HostTime reading);
  // Whether a program has set or steered the clock.
  bool was_steered() const { return kernel_.was_steered(); }
  // Until one has, or this time has come; nothing: for ever. One coroutine at a time.
  Task<void> until_steered(std::optional<TrueTime> limit);

 private:
  SimHost& host_;
  WaitPoint changed_;
  WaitPoint steered_;
  clocks::KernelDiscipline kernel_;
};

}  // namespace simbench::sim
