// Windows Time (W32Time): SNTP, one poll every few hours on a stand-alone machine, at least one
// every 17 minutes on a member of a domain.
//
// W32Time is closed. This follows its public documentation, not its code. Jitter filtering and the
// adaptive poll interval (PollAdjustFactor) are not published and not here; the interval is fixed.
//
// The master serves as a local reference of stratum 1 (ntp_association.h). Each slave is a client
// (NTPv3): first after a random part of start_spread, then every poll_interval, it makes one
// exchange. A request without a valid reply within kW32TimeReplyTimeout is repeated, kRequestLimit
// times in all; then the client waits for the next poll.
//
// Phase (Microsoft, "Windows Time service tools and settings"): with
//
//   adjustment = |offset| / (16 * PhaseCorrectRate * poll interval in seconds)
//
// in units of 100 ns per clock tick (ClockRate 156250 units, 15.625 ms), slew by that adjustment
// if |offset| < MaxAllowedPhaseOffset and adjustment <= ClockRate / 2; else set. A slew always
// takes 16 * PhaseCorrectRate * poll ticks. Example: 0.54 s at a poll of 1024 s and
// PhaseCorrectRate 7 gives 47 units a tick, 301 ppm, for 1792 s. (Until Windows Server 2012 R2 the
// divisor was PhaseCorrectRate * UpdateInterval.)
//
// Frequency: w32time_rate_change() below. The service starts with LastClockRate, where an earlier
// run has left one (Host::stored_frequency).
//
// Spikes are ignored (W32TimeSpikes), and offsets above max_phase_correction are not corrected.
//
// A service: it never ends. warm_up() is how long it has run when the capture starts. A slave
// reports how its first poll ended, and every exchange.
//
// Source: docs/reference/host_sync.md section 2 (W32Time); RFC 4330; RFC 5905.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/host_sync/clock_service.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"

namespace simbench {

// W32Time's states: protection against single wrong samples, and when the rate is corrected.
//
//  - Hold: the first kHoldPeriod samples, and as many after each accepted large offset, are
//    accepted, "to bring the local clock into synchronization quickly". Meanwhile only the time is
//    corrected, not the clock's rate.
//  - Then an offset of kLargePhaseOffset or more is a spike: ignored until such offsets have
//    persisted for kSpikeWatchPeriod. A smaller offset ends the suspicion.
//
// Source: docs/reference/host_sync.md section 2 (LargePhaseOffset, HoldPeriod, SpikeWatchPeriod);
// Microsoft, "Windows Time service tools and settings", the policy W32TIME_POLICY_CONFIG
// (HoldPeriod counts samples), [MS-W32T] 2.2.7 (HOLD: time only; SYNC: time and rate).
//
//   W32TimeSpikes spikes;
//   if (spikes.accept(offset, host.steady_clock().now())) correct_the_clock();
//   if (spikes.corrects_rate()) adjustment();
class W32TimeSpikes {
 public:
  static constexpr Nanoseconds kLargePhaseOffset{5'000'000'000};
  static constexpr Nanoseconds kSpikeWatchPeriod{900'000'000'000};
  static constexpr int kHoldPeriod = 5;

  // Whether the clock may be corrected by a sample of this offset, taken at `at`.
  bool accept(Nanoseconds offset, SteadyTime at);
  // Whether the sample accepted last came after the hold.
  bool corrects_rate() const { return !was_held_; }

 private:
  bool was_held_ = true;
  int held_ = 0;                         // samples taken since the hold began
  std::optional<SteadyTime> suspicion_;  // since the first large offset of the present ones
};

// How samples correct the clock's rate: what the documentation says allows each of these.
enum class W32TimeRate : std::uint8_t {
  kHybrid,  // PLL and FLL
  kPll,     // PLL alone
  kHeld,    // not at all: the phase rule stands alone, as in the hold
};

struct W32TimeSettings {
  Nanoseconds poll_interval = from_ms(32768e3);
  double phase_correct_rate = 7;
  double frequency_correct_rate = 4;
  W32TimeRate rate = W32TimeRate::kHybrid;
  Nanoseconds max_allowed_phase_offset = from_ms(1000);
  Nanoseconds service_time = from_ms(20 * 3600e3);
  Nanoseconds start_spread = from_ms(32768e3);
  // MaxPosPhaseCorrection and MaxNegPhaseCorrection; nothing: any offset is corrected.
  std::optional<Nanoseconds> max_phase_correction = from_ms(54000e3);

  void bind(ParameterBinder& parameters);
};

// The defaults of a member of a domain: MinPollInterval 10, PhaseCorrectRate 1,
// MaxAllowedPhaseOffset 300 s, corrections without limit.
W32TimeSettings w32time_domain_settings();

// How an offset is corrected.
struct W32TimeCorrection {
  bool set = false;           // step the clock; else slew it
  double units_per_tick = 0;  // the rule's adjustment, in 100 ns per tick
  double rate_ppb = 0;        // the same as a rate
};

W32TimeCorrection w32time_correction(Nanoseconds offset, const W32TimeSettings& settings);

// The largest correction of the rate: Min- and MaxClockRate, 250 of 100 144 units.
inline constexpr double kW32TimeMaxRate = 2.5e-3;

// By how much a sample of this offset changes the correction of the clock's rate, as a fraction;
// `interval` is the time since the last sample that was accepted.
//
//  - PLL: offset * interval / (4 * gain)^2. The gain at a poll of 64 s is FrequencyCorrectRate
//  times
//    the clock ticks in 64 s, as documented; that it grows with the poll is how adaptive loops are
//    made, and without it the loop would not be stable at the documented polls.
//  - FLL: offset / (4 * max(interval, 1024 s)), fading in from 256 to 1280 s. [MS-W32T] names the
//    algorithm, UDel TR 97-3; the numbers are those of its implementation of 1999.
//
// Microsoft documents neither formula. The result is a reading of what it documents.
// Source: Microsoft, "FrequencyCorrectRate Entry" (Windows Server 2003); [MS-W32T] 2.2.7;
// ntp_loopfilter.c of May 1999 (CLOCK_AVG, CLOCK_ALLAN, CLOCK_MINSEC).
double w32time_rate_change(Nanoseconds offset, Nanoseconds interval,
                           const W32TimeSettings& settings);

inline constexpr Nanoseconds kW32TimeReplyTimeout{1'000'000'000};
inline constexpr std::uint32_t kW32TimeRequestLimit = 4;

Task<void> serve_w32time(Host& host, std::vector<PeerId> slaves, W32TimeSettings settings);
Task<void> follow_w32time(Host& host, PeerId master, W32TimeSettings settings);
using W32Time = ClockService<W32TimeSettings, serve_w32time, follow_w32time>;

}  // namespace simbench
