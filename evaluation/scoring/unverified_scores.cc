#include "evaluation/scoring/unverified_scores.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

Nanoseconds duration_of(std::int64_t frames, double rate_hz) {
  return Nanoseconds(std::llround(static_cast<double>(frames) * 1e9 / rate_hz));
}

bool all_evaluated(std::span<const GatherFrame> set) {
  return std::all_of(set.begin(), set.end(),
                     [](const GatherFrame& frame) { return frame.tag == kUnknownPulse; });
}

}  // namespace

UnverifiedScores::UnverifiedScores(const RigLayout& layout, MedianKind median,
                                   ScoreObserver* observer)
    : median_(median),
      observer_(observer),
      warm_up_(duration_of(layout.first_pulse, layout.frame_rate_hz)),
      end_(duration_of(layout.first_pulse + layout.pulses, layout.frame_rate_hz)),
      first_arrival_(layout.hosts),
      evaluated_count_(layout.cameras.size()) {
  for (const CameraLayout& camera : layout.cameras) host_of_camera_.push_back(camera.host);
}

UnverifiedScores::Part UnverifiedScores::part_of(const FrameRecord& frame) {
  std::optional<SteadyTime>& first = first_arrival_.at(host_of_camera_.at(frame.camera));
  if (!first) first = frame.arrival_steady;
  const Nanoseconds since = frame.arrival_steady - *first;
  if (since < warm_up_) return Part::kWarmUp;
  if (since >= end_) return Part::kAfter;
  count(frame);
  return Part::kEvaluated;
}

// The counter is a register that wraps: differences are taken modulo 2^32.
void UnverifiedScores::count(const FrameRecord& frame) {
  ++frames_.delivered;
  std::optional<std::uint32_t>& last = evaluated_count_[frame.camera];
  if (last) {
    const std::uint32_t step = frame.counter - *last;
    if (step > 1 && step <= kLongestGap) frames_.dropped += step - 1;
  }
  last = frame.counter;
}

void UnverifiedScores::on_partial_set(std::span<const GatherFrame> set) {
  if (!all_evaluated(set)) return;
  ++partial_;
  if (observer_ != nullptr) observer_->on_set(set, /*complete=*/false, now());
}

void UnverifiedScores::on_set(std::span<const GatherFrame> set) {
  SIMBENCH_ASSERT(!set.empty(), "a set has members");
  if (!all_evaluated(set)) return;
  stamps_ns_.clear();
  GlobalTime latest_arrival = set.front().arrival;
  for (const GatherFrame& frame : set) {
    stamps_ns_.push_back(nanoseconds_of(frame.stamp));
    latest_arrival = std::max(latest_arrival, frame.arrival);
  }
  const double latency_ms = to_ms(now() - latest_arrival);
  latency_max_ms_ = sets_.empty() ? latency_ms : std::max(latency_max_ms_, latency_ms);
  latency_sum_ms_ += latency_ms;
  PulseScore& scored =
      sets_.emplace_back(PulseScore{.pulse = static_cast<std::int64_t>(sets_.size())});
  if (host_of_camera_.size() > 1) {  // the stamp of a single camera has no range
    scored.spread_ms = spread_ms(stamps_ns_);
    const Differences differences = differences_from_median(stamps_ns_, median_, sorted_);
    scored.deviation_ms = differences.deviation_ms;
    printed_.add(differences);
  }
  if (observer_ != nullptr) observer_->on_set(set, /*complete=*/true, now());
}

void UnverifiedScores::score(SeedScore& score) const {
  score.frames = frames_;
  score.frames.expected = frames_.delivered + frames_.dropped;
  score.sets = {};
  score.sets.emitted = static_cast<std::int64_t>(sets_.size());
  score.sets.partial = partial_;
  score.pulses = sets_;
  if (sets_.empty()) return;  // the scores stay NaN
  const auto count = static_cast<double>(sets_.size());
  double spreads_ms = 0;
  double deviations_ms = 0;
  for (const PulseScore& set : sets_) {
    spreads_ms += set.spread_ms;
    deviations_ms += set.deviation_ms;
  }
  score.emission_latency_ms = latency_sum_ms_ / count;
  score.emission_latency_max_ms = latency_max_ms_;
  if (host_of_camera_.size() < 2) return;
  score.amd_ms = spreads_ms / count;
  score.set_amd_ms = score.amd_ms;
  score.rmdv_ms = deviations_ms / count;
  score.rmdv_printed_sqrt_ms = printed_.mean_sqrt_ms();
  score.rmdv_printed_share = printed_.real_share();
}

}  // namespace simbench::evaluation
