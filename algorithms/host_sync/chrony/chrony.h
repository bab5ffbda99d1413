// chrony as deployed: chronyd as the client on each slave, a stratum 1 server on the master.
//
// The client polls 2^poll s after a reply (and up to 2 % more, at random), first until it has four
// good samples, at most eight times, at 2 s or a quarter of the shortest interval (iburst). A line
// is fitted to its samples (chrony_source_stats.h); after every good sample from the third on the
// clock takes over the line's frequency and offset (ChronyReference): the frequency at once, the
// offset by a slew, or by a step (makestep). The poll adapts (ChronyPoll). Samples with a delay
// above 3 s, and those that are not good (ChronySourceStats::is_good), are discarded.
//
// Interleaved mode (xleave): a sample is complete when the next reply brings the server's departure
// stamp, so it is one poll old. The reply after the first basic one gives none.
//
// Where the host has a drift file, the clock starts with its frequency and its error as the skew.
//
// Stamps are taken while the system clock slews. Offsets are therefore kept for the clock as it
// would read if what is left of the slew had been added at once.
//
// A service: warm_up() is how long it has run when the capture starts; it never ends. The outcome
// is "synchronised" at the first correction of the clock, and a failure after eight polls without a
// valid reply, or, where the kernel's stamps are asked for, when the host's stack takes none.
//
// The frequency is within what the clock takes: 10 % on Linux, by the kernel's tick.
//
// Not here: several sources and their selection, the sample filter option, refclocks, the slower
// rate of what a slew has left after 10000 s. chrony has no broadcast client.
//
// Source: docs/reference/host_sync.md sections 1 and 2 (chrony 4.3); chrony.conf documentation.
//
//   ChronyService chrony({});
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/host_sync/chrony/chrony_source_stats.h"
#include "algorithms/host_sync/clock_service.h"
#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host.h"

namespace simbench {

// chrony's poll interval: long enough that about `target` samples lie on one line.
//
// A score moves by (samples/target - 1)/target per sample, twice that downwards; a prediction whose
// error exceeds the sample's distance (delay/2 + dispersion) moves it by -log2(error/distance)
// instead. From 1 on its whole part is added to the exponent, below 0 its whole part less one. At
// the lower bound the score is 0, at the upper one 1: there the next step down needs a whole point.
//
// Source: docs/reference/host_sync.md section 2 (polltarget 8; ntp_core.c).
class ChronyPoll {
 public:
  // Exponents, log2 s. It begins with `low`, but with no less than a second.
  ChronyPoll(int low, int high, double target)
      : low_(low), high_(high), target_(target), exponent_(std::max(low, 0)) {}

  // `distance_s` must be > 0.
  void update(std::size_t samples, double error_s, double distance_s) {
    if (error_s > distance_s) return add(-std::log2(error_s / distance_s));
    const double change = (static_cast<double>(samples) / target_ - 1) / target_;
    add(change < 0 ? 2 * change : change);
  }

  // Moves the score.
  void add(double change) {
    score_ += change;
    const double steps = score_ < 0 ? std::trunc(score_ - 1) : std::trunc(score_);
    const double wanted = exponent_ + steps;
    score_ -= steps;
    if (wanted < low_) score_ = 0;
    if (wanted > high_) score_ = 1;
    exponent_ = static_cast<int>(std::clamp<double>(wanted, low_, high_));
  }

  // An interval below a second is for a server that replies, and in a local network.
  void keep_whole_seconds() { exponent_ = std::max(exponent_, 0); }

  int exponent() const { return exponent_; }
  double interval_s() const { return std::ldexp(1.0, exponent_); }

 private:
  int low_;
  int high_;
  double target_;
  int exponent_;
  double score_ = 0;
};

// chrony's use of an estimate: how far to change the frequency, and how fast to slew the offset.
//
//  - Frequency: the skews weigh the measured one against the present one,
//    gain = 3 s^2 / (3 s^2 + m^2) with s the present skew and m the measured one; a measurement
//    with a skew above max_update_skew_ppm changes nothing. The skew follows by the same gain,
//    widened by how much the two disagree.
//  - Offset: a slew corrects all of it. An offset as large as the estimate's own deviation takes
//    half of correction_ratio times the interval between updates; a larger one is corrected faster
//    in proportion, in no less than 1 s, at no more than max_slew_ppm.
//  - Step: in the first step_updates updates an offset above step_threshold_s is stepped instead.
//
// A pure state machine.
// Source: docs/reference/host_sync.md section 2 (chrony, conf.c, reference.c); chrony.conf
// documentation (corrtimeratio, maxslewrate, maxupdateskew, makestep); sys_linux.c (10 %).
//
//   ChronyReference reference({});
//   const ChronyCorrection correction = reference.update(*stats.estimate(), now_s, left_s);
struct ChronyReferenceSettings {
  double correction_ratio = 3;  // corrtimeratio
  double max_slew_ppm = 83333.333;
  double max_update_skew_ppm = 1000;
  double max_frequency = 0.1;  // as a fraction; the clock's
  double step_threshold_s = 1;
  int step_updates = 0;
};

struct ChronyCorrection {
  double frequency = 0;  // change of the clock's rate, as a fraction
  double offset_s = 0;   // to be added to what was still to be slewed
  double slew_rate = 0;  // for all that is then left, as a fraction; 0 if nothing is
  bool is_step = false;  // all that is then left is to be stepped
};

class ChronyReference {
 public:
  static constexpr double kMinSkew = 1e-12;

  explicit ChronyReference(const ChronyReferenceSettings& settings) : settings_(settings) {}

  // Begins with a known frequency, as a drift file has it; both as fractions.
  void start_with(double frequency, double skew) {
    frequency_ = std::clamp(frequency, -settings_.max_frequency, settings_.max_frequency);
    skew_ = std::max(skew, kMinSkew);
  }

  // `left_s` is what an unfinished slew has still to add.
  ChronyCorrection update(const ChronyEstimate& estimate, double now_s, double left_s);

  double frequency() const { return frequency_; }  // correction in all, as a fraction
  double skew() const { return skew_; }

 private:
  double change_of_frequency(const ChronyEstimate& estimate);

  ChronyReferenceSettings settings_;
  double frequency_ = 0;
  double skew_ = 1;  // nothing is known
  int updates_ = 0;
  std::optional<double> last_update_s_;
};

enum class ChronyStamps : std::uint8_t {
  kAvailable,    // the kernel's where it stamps, else the program's, as chronyd takes them
  kKernel,       // the kernel's, or the service fails
  kApplication,  // t1 from before the send
  kProgram,      // all from the program: no stamps of the kernel, on either side
  kCard,         // all from the network card, converted to the system clock (hwtimestamp)
};

struct ChronySettings {
  ChronyStatsSettings stats{};
  ChronyReferenceSettings reference{};
  int poll_min = 6;  // log2 s
  int poll_max = 10;
  double poll_target = 8;  // samples
  bool initial_burst = true;
  bool is_interleaved = false;
  ChronyStamps stamps = ChronyStamps::kAvailable;
  Nanoseconds service_time = from_ms(4 * 3600e3);

  void bind(ParameterBinder& parameters);
};

Task<void> serve_chronyd(Host& host, std::vector<PeerId> slaves, ChronySettings settings);
Task<void> follow_chronyd(Host& host, PeerId master, ChronySettings settings);
// It says that it is not synchronised until the client's side has corrected its clock.
Task<void> relay_chronyd(Host& host, PeerId master, std::vector<PeerId> slaves,
                         ChronySettings settings);
using ChronyService = ClockService<ChronySettings, serve_chronyd, follow_chronyd, relay_chronyd>;

struct UnfinishedSlew {
  double offset_s = 0;
  double rate = 0;  // as a fraction
  double start_s = 0;
  double duration_s = 0;  // of the part that was begun

  // What it has still to add at a time from its start on.
  double left_s(double at_s) const;
};

}  // namespace simbench
