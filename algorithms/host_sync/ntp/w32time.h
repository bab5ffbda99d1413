// Windows Time (W32Time): SNTP, one poll every few hours on a stand-alone machine, at least one
// every 17 minutes on a member of a domain.
//
// W32Time is closed. This follows its public documentation (registry entries and the stated rule
// for setting or slewing), not its code. Jitter filtering, frequency correction
// (FrequencyCorrectRate, UpdateInterval) and the adaptive poll interval are not published and not
// here; the interval is fixed.
//
// The master serves as a local reference of stratum 1 (ntp_association.h). Each slave is a client
// (NTPv3): first after a random part of start_spread, then every poll_interval, it makes one
// exchange. A request without a valid reply within kReplyTimeout is repeated, kRequestLimit times
// in all; then the client waits for the next poll.
//
// The rule (Microsoft, "Windows Time service tools and settings"): with
//
//   adjustment = |offset| / (16 * PhaseCorrectRate * poll interval in seconds)
//
// in units of 100 ns per clock tick (ClockRate 156250 units, 15.625 ms), slew by that adjustment
// if |offset| < MaxAllowedPhaseOffset and adjustment <= ClockRate / 2; else set. So a slew always
// takes 16 * PhaseCorrectRate * poll ticks. Example: 0.54 s at a poll of 1024 s and
// PhaseCorrectRate 7 gives 47 units a tick, 301 ppm, for 1792 s.
//
// Spikes are ignored (W32TimeSpikes), and offsets above max_phase_correction are not corrected.
//
// A service: it never ends. warm_up() is how long it has run when the capture starts. A slave
// reports how its first poll ended, and every exchange.
//
// Source: docs/reference/host_sync.md section 2 (W32Time); RFC 4330; RFC 5905.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/ports/time.h"

namespace simbench {

// W32Time's protection against single wrong samples, as documented.
//
//  - Hold: the first kHoldPeriod samples, and as many after each accepted large offset, are
//    accepted, "to bring the local clock into synchronization quickly".
//  - Then an offset of kLargePhaseOffset or more is a spike: ignored until such offsets have
//    persisted for kSpikeWatchPeriod. A smaller offset ends the suspicion.
//
// The documentation gives HoldPeriod without a unit; that it counts samples is an assumption.
// Source: docs/reference/host_sync.md section 2 (LargePhaseOffset, HoldPeriod, SpikeWatchPeriod);
// Microsoft, "Windows Time service tools and settings".
//
//   W32TimeSpikes spikes;
//   if (spikes.accept(offset, host.steady_clock().now())) correct_the_clock();
class W32TimeSpikes {
 public:
  static constexpr Nanoseconds kLargePhaseOffset{5'000'000'000};
  static constexpr Nanoseconds kSpikeWatchPeriod{900'000'000'000};
  static constexpr int kHoldPeriod = 5;

  // Whether the clock may be corrected by a sample of this offset, taken at `at`.
  bool accept(Nanoseconds offset, SteadyTime at);

 private:
  int held_ = 0;                         // samples taken since the hold began
  std::optional<SteadyTime> suspicion_;  // since the first large offset of the present ones
};

struct W32TimeSettings {
  Nanoseconds poll_interval = from_ms(32768e3);
  double phase_correct_rate = 7;
  Nanoseconds max_allowed_phase_offset = from_ms(1000);
  Nanoseconds service_time = from_ms(20 * 3600e3);
  Nanoseconds start_spread = from_ms(32768e3);
  // MaxPosPhaseCorrection and MaxNegPhaseCorrection; nothing: any offset is corrected.
  std::optional<Nanoseconds> max_phase_correction = from_ms(54000e3);
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

class W32Time : public HostSync {
 public:
  static constexpr Nanoseconds kReplyTimeout{1'000'000'000};
  static constexpr std::uint32_t kRequestLimit = 4;

  explicit W32Time(W32TimeSettings settings) : settings_(settings) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  W32TimeSettings settings_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_H_
