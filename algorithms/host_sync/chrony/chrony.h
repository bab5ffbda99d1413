// chrony as deployed: chronyd as the client on each slave, a stratum 1 server on the master.
//
// The client polls every 2^poll s (and up to 2 % more, at random), first four times at 2 s
// (iburst). Its samples are fitted by a line (chrony_source_stats.h), of which frequency and offset
// are taken over after every good sample from the third on (ChronyReference): the frequency at
// once, the offset by a slew, never by a step. The poll adapts (ChronyPoll). A sample with a
// delay above 3 s, or one that is_good() refuses, is dropped.
//
// The system clock is stamped while it slews. Offsets are therefore kept for the clock as it would
// read if what is left of the slew had been added at once.
//
// A service: warm_up() is how long it has run when the capture starts; it never ends. Outcome:
// synchronised at the first correction of the clock; not, after eight polls without a valid reply.
//
// Not here: several sources and their selection, makestep, the sample filter option, interleaved
// mode, refclocks. chrony has no broadcast client.
//
// Source: docs/reference/host_sync.md sections 1 and 2 (chrony); chrony.conf documentation.
//
//   ChronyService chrony({});
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/host_sync/chrony/chrony_source_stats.h"
#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

// chrony's poll interval: long enough that about `target` samples lie on one line.
//
// A score moves by (samples/target - 1)/target a sample, twice that downwards; a prediction that
// fails by more than the sample's distance (delay/2 + dispersion) moves it by -log2(error/distance)
// instead. Each whole point of the score is one step of the exponent, within its bounds.
//
// Source: docs/reference/host_sync.md section 2 (polltarget 8; ntp_core.c).
class ChronyPoll {
 public:
  // Exponents, log2 s.
  ChronyPoll(int low, int high, double target)
      : low_(low), high_(high), target_(target), exponent_(low) {}

  // `distance_s` must be > 0.
  void update(std::size_t samples, double error_s, double distance_s) {
    if (error_s > distance_s) {
      score_ -= std::log2(error_s / distance_s);
    } else {
      const double change = (static_cast<double>(samples) / target_ - 1) / target_;
      score_ += change < 0 ? 2 * change : change;
    }
    const double steps = std::floor(score_);
    const double wanted = std::clamp<double>(exponent_ + steps, low_, high_);
    score_ = wanted == exponent_ + steps ? score_ - steps : 0;
    exponent_ = static_cast<int>(wanted);
  }

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
//  - Frequency: the measured one is trusted against the present one by their skews,
//    gain = 3 s^2 / (3 s^2 + m^2) with s the present skew and m the measured one; a measurement
//    with a skew above max_update_skew changes nothing. The skew follows by the same gain, widened
//    by how much the two disagree.
//  - Offset: all of it is corrected, by a slew. An offset as large as the estimate's own deviation
//    takes correction_ratio times the interval between updates; a larger one is corrected faster in
//    proportion, in no less than 1 s, at no more than max_slew_rate.
//
// A pure state machine. chrony steps only if it is told to (makestep), which is not here.
// Source: docs/reference/host_sync.md section 2 (chrony, conf.c); chrony.conf documentation
// (corrtimeratio, maxslewrate, maxupdateskew).
//
//   ChronyReference reference({});
//   const ChronyCorrection correction = reference.update(*stats.estimate(), now_s, left_s);
struct ChronyReferenceSettings {
  double correction_ratio = 3;       // corrtimeratio
  double max_slew_rate = 83333e-6;   // as a fraction
  double max_update_skew = 1000e-6;  // as a fraction
};

struct ChronyCorrection {
  double frequency = 0;  // change of the clock's rate, as a fraction
  double offset_s = 0;   // to be added to what was still to be slewed
  double slew_rate = 0;  // for all that is left then, as a fraction; 0 if nothing is
};

class ChronyReference {
 public:
  static constexpr double kMaxFrequency = 500e-6;

  explicit ChronyReference(const ChronyReferenceSettings& settings) : settings_(settings) {}

  // `left_s` is what an unfinished slew has still to add.
  ChronyCorrection update(const ChronyEstimate& estimate, double now_s, double left_s);

  double frequency() const { return frequency_; }  // correction in all, as a fraction
  double skew() const { return skew_; }

 private:
  double change_of_frequency(const ChronyEstimate& estimate);

  ChronyReferenceSettings settings_;
  double frequency_ = 0;
  double skew_ = 1;  // nothing is known
  std::optional<double> last_update_s_;
};

struct ChronySettings {
  ChronyStatsSettings stats;
  ChronyReferenceSettings reference;
  int poll_min = 6;  // log2 s
  int poll_max = 10;
  double poll_target = 8;  // samples
  bool initial_burst = true;
  NtpStamps stamps = NtpStamps::kApplication;
  Nanoseconds service_time = from_ms(4 * 3600e3);
};

class ChronyService : public HostSync {
 public:
  explicit ChronyService(const ChronySettings& settings) : settings_(settings) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  ChronySettings settings_;
};

// The client of ChronyService on one slave (ChronyService says what it does).

// What a slew has still to add, at any time from its start on.
struct UnfinishedSlew {
  double offset_s = 0;
  double rate = 0;  // as a fraction
  double start_s = 0;
  double duration_s = 0;  // of the part of it that was begun

  double left_s(double at_s) const;
};

class ChronyClient {
 public:
  static constexpr int kBurst = 4;
  static constexpr Nanoseconds kBurstSpacing{2'000'000'000};
  static constexpr Nanoseconds kMaxDelay{3'000'000'000};
  static constexpr std::uint32_t kPatience = 8;  // polls without reply, then it is an outcome

  // The host must outlive the client, the client its coroutines.
  ChronyClient(Host& host, PeerId server, const ChronySettings& settings);

  // Endless.
  Task<void> run();

 private:
  Task<void> poll();
  // Whether there is an estimate to correct the clock by.
  bool use(const NtpMeasurement& measurement);
  Task<void> correct();
  // Adds `offset_s` at a rate, as a fraction; in parts, each as long as is sure to be needed.
  Task<void> slew(double offset_s, double rate);
  // The measurement as seen by the clock that has finished its slew.
  ChronySample sample_of(const NtpMeasurement& measurement) const;

  double seconds(SteadyTime at) const { return to_seconds(at - start_); }
  double now_s() const { return seconds(host_.steady_clock().now()); }
  void report(bool synchronised);

  Host& host_;
  PeerId server_;
  ChronySettings settings_;
  NtpAssociation association_;
  ChronySourceStats stats_;
  ChronyReference reference_;
  ChronyPoll poll_;
  UnfinishedSlew slew_;
  SteadyTime start_;
  std::uint32_t polls_ = 0;
  std::uint32_t replies_ = 0;
  int good_samples_ = 0;
  bool reported_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_H_
