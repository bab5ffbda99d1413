#include "evaluation/scoring/alignment_scores.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kSecondsPerNs = 1e-9;
constexpr double kUsPerNs = 1e-3;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr double kDisturbedFrom = 0.01;  // of a frame's length or exposure
constexpr double kWrongLockFrom = 0.1;   // of the period
constexpr std::int32_t kCountsForNone = -1;

// Keeps differences from overflowing.
std::int64_t bounded_ns(TrueTime time) {
  constexpr std::int64_t kFarthestNs = (std::int64_t{1} << 62) - 1;
  return std::clamp(nanoseconds_of(time), -kFarthestNs, kFarthestNs);
}

bool is_unlike(double value, double median) {
  return std::abs(value - median) > kDisturbedFrom * std::abs(median);
}

// Calls use(second, begin, end) for each run of items, in order, that are of the same second.
template <class Items, class SecondOf, class Use>
void by_second(const Items& items, SecondOf second_of, Use use) {
  auto begin = items.begin();
  while (begin != items.end()) {
    const std::int64_t second = second_of(*begin);
    const auto end = std::find_if(begin, items.end(),
                                  [&](const auto& item) { return second_of(item) != second; });
    use(second, begin, end);
    begin = end;
  }
}

}  // namespace

AlignmentScores::AlignmentScores(const RigLayout& layout, Nanoseconds unsteady_start)
    : period_ns_(1e9 / layout.frame_rate_hz),
      unsteady_ns_(unsteady_start > Nanoseconds(0) ? to_ns(unsteady_start) + period_ns_ : 0),
      first_pulse_(layout.first_pulse),
      end_pulse_(std::min<std::int64_t>(layout.first_pulse + layout.pulses,
                                        std::numeric_limits<std::int32_t>::max())),
      start_ns_(std::numeric_limits<std::int64_t>::max()),
      cameras_(layout.cameras.size()) {}

std::int32_t AlignmentScores::pulse_that_counts(std::int64_t pulse) const {
  return pulse >= 0 && pulse < end_pulse_ ? static_cast<std::int32_t>(pulse) : kCountsForNone;
}

void AlignmentScores::add(const FrameRecord& frame, const FrameTruth& truth) {
  SIMBENCH_ASSERT(frame.camera < cameras_.size(), "a frame of a camera of the rig");
  constexpr Nanoseconds::rep kLongest = std::numeric_limits<std::uint32_t>::max();
  const Nanoseconds exposure = truth.exposure_end - truth.exposure_start;
  start_ns_ = std::min(start_ns_, bounded_ns(truth.exposure_start));
  cameras_[frame.camera].push_back({.mid_ns = bounded_ns(truth.mid_exposure()),
                                    .pulse = pulse_that_counts(truth.pulse),
                                    .counter = frame.counter,
                                    .exposure_ns = static_cast<std::uint32_t>(std::clamp(
                                        exposure.count(), Nanoseconds::rep{0}, kLongest))});
}

void AlignmentScores::add(const AlignmentReport& report) { reports_[report.camera] = report; }

std::string AlignmentScores::problem() const {
  const auto found = std::ranges::find_if(reports_, [](const auto& each) {
    return !each.second.aligned && !each.second.message.empty();
  });
  return found != reports_.end() ? found->second.message : "";
}

std::vector<AlignmentScores::Pulse> AlignmentScores::pulses_of_reference() const {
  std::vector<Pulse> pulses;
  pulses.reserve(cameras_.front().size());
  for (const Frame& frame : cameras_.front()) {
    if (frame.pulse == kCountsForNone) continue;
    pulses.push_back({.pulse = frame.pulse,
                      .cameras = 1,
                      .reference_ns = frame.mid_ns,
                      .least_ns = frame.mid_ns,
                      .greatest_ns = frame.mid_ns});
  }
  std::ranges::stable_sort(pulses, {}, &Pulse::pulse);
  // Not std::ranges::unique, whose result clang 14 cannot take apart.
  const auto again = std::unique(
      pulses.begin(), pulses.end(),
      [](const Pulse& first, const Pulse& second) { return first.pulse == second.pulse; });
  pulses.erase(again, pulses.end());
  return pulses;
}

std::vector<AlignmentScores::Pulse> AlignmentScores::complete_pulses() const {
  std::vector<Pulse> pulses = pulses_of_reference();
  for (std::uint32_t camera = 1; camera < cameras_.size(); ++camera) {
    for (const Frame& frame : cameras_[camera]) {
      const auto found = std::ranges::lower_bound(pulses, frame.pulse, {}, &Pulse::pulse);
      if (found == pulses.end() || found->pulse != frame.pulse) continue;
      if (found->newest_camera == camera) continue;
      found->newest_camera = camera;
      ++found->cameras;
      found->least_ns = std::min(found->least_ns, frame.mid_ns);
      found->greatest_ns = std::max(found->greatest_ns, frame.mid_ns);
    }
  }
  std::erase_if(pulses, [this](const Pulse& pulse) { return pulse.cameras < cameras_.size(); });
  return pulses;
}

void AlignmentScores::add_spreads(const std::vector<Pulse>& complete,
                                  MetricValues<double>& score) const {
  std::vector<double> spreads_ms;
  for (const Pulse& pulse : complete) {
    if (is_evaluated(pulse.pulse)) spreads_ms.push_back(pulse.spread_ms());
  }
  if (spreads_ms.empty()) return;
  std::ranges::sort(spreads_ms);
  score.exposure_spread_median_ms = quantile_of_sorted(spreads_ms, 0.5);
  score.exposure_spread_p95_ms = quantile_of_sorted(spreads_ms, 0.95);
}

void AlignmentScores::add_aligned(const std::vector<Pulse>& complete,
                                  MetricValues<double>& score) const {
  constexpr std::array<std::pair<double, double MetricValues<double>::*>, 3> kBoundsMs = {
      {{1, &MetricValues<double>::aligned_1_ms_s},
       {0.1, &MetricValues<double>::aligned_0_1_ms_s},
       {0.01, &MetricValues<double>::aligned_0_01_ms_s}}};
  for (const auto& [bound_ms, aligned_s] : kBoundsMs) {
    if (!complete.empty()) score.*aligned_s = 0;
  }
  const auto second_of = [this](const Pulse& pulse) {
    return floor_div(pulse.reference_ns - start_ns_, kNsPerSecond);
  };
  by_second(complete, second_of, [&](std::int64_t second, auto begin, auto end) {
    std::vector<double> spreads_ms;
    for (auto pulse = begin; pulse != end; ++pulse) spreads_ms.push_back(pulse->spread_ms());
    const double spread_ms = median(std::move(spreads_ms));
    for (const auto& [bound_ms, aligned_s] : kBoundsMs) {
      if (spread_ms < bound_ms) continue;
      score.*aligned_s = end == complete.end() ? kNan : static_cast<double>(second + 1);
    }
  });
}

std::optional<std::int64_t> AlignmentScores::disturbed_frames(
    const std::vector<Frame>& frames) const {
  const auto steady = std::ranges::find_if(frames, [&](const Frame& frame) {
    return static_cast<double>(frame.mid_ns - frames.front().mid_ns) >= unsteady_ns_;
  });
  std::vector<double> lengths_ns;
  std::vector<double> exposures_ns;
  for (auto frame = steady; frame != frames.end(); ++frame) {
    const auto next = frame + 1;
    const bool is_followed = next != frames.end() && next->counter == frame->counter + 1;
    lengths_ns.push_back(is_followed ? static_cast<double>(next->mid_ns - frame->mid_ns) : kNan);
    exposures_ns.push_back(static_cast<double>(frame->exposure_ns));
  }
  if (lengths_ns.empty()) return std::nullopt;
  const double length_ns = median(lengths_ns);
  const double exposure_ns = median(exposures_ns);
  std::int64_t disturbed = 0;
  for (std::size_t i = 0; i < lengths_ns.size(); ++i) {
    if (is_unlike(lengths_ns[i], length_ns) || is_unlike(exposures_ns[i], exposure_ns)) ++disturbed;
  }
  return disturbed;
}

std::vector<AlignmentScores::Distance> AlignmentScores::distances(
    std::size_t camera, const std::vector<Pulse>& reference) const {
  std::vector<Distance> found;
  std::int32_t newest = kCountsForNone;
  for (const Frame& frame : cameras_[camera]) {
    if (!is_evaluated(frame.pulse) || frame.pulse == newest) continue;
    const auto at = std::ranges::lower_bound(reference, frame.pulse, {}, &Pulse::pulse);
    if (at == reference.end() || at->pulse != frame.pulse) continue;
    newest = frame.pulse;
    const std::int64_t since_first = at->reference_ns - reference.front().reference_ns;
    found.push_back({.at_s = static_cast<double>(since_first) * kSecondsPerNs,
                     .us = static_cast<double>(frame.mid_ns - at->reference_ns) * kUsPerNs});
  }
  return found;
}

double AlignmentScores::drift_ppm(const std::vector<Distance>& distances, double seconds) const {
  std::vector<double> drifts_ppm;
  const auto second_of = [](const Distance& each) {
    return static_cast<std::int64_t>(std::floor(each.at_s));
  };
  by_second(distances, second_of, [&](std::int64_t second, auto begin, auto end) {
    if (static_cast<double>(second + 1) > seconds) return;
    std::vector<double> at_s;
    std::vector<double> us;
    for (auto each = begin; each != end; ++each) {
      at_s.push_back(each->at_s);
      us.push_back(each->us - begin->us);  // so that what is constant has no slope
    }
    drifts_ppm.push_back(std::abs(fit_line(at_s, us).slope));
  });
  return median(std::move(drifts_ppm));
}

void AlignmentScores::add_distances(MetricValues<double>& score) const {
  std::vector<Pulse> reference = pulses_of_reference();
  std::erase_if(reference, [this](const Pulse& pulse) { return !is_evaluated(pulse.pulse); });
  if (reference.empty()) return;
  const auto span_ns =
      static_cast<double>(reference.back().reference_ns - reference.front().reference_ns);
  const double seconds = (span_ns + period_ns_) * kSecondsPerNs;
  if (!reports_.empty()) score.wrong_locks = 0;
  for (std::uint32_t camera = 1; camera < cameras_.size(); ++camera) {
    const std::vector<Distance> found = distances(camera, reference);
    score.exposure_drift_ppm = std::fmax(score.exposure_drift_ppm, drift_ppm(found, seconds));
    const auto report = reports_.find(camera);
    if (report == reports_.end() || !report->second.aligned) continue;
    std::vector<double> sizes_us;
    sizes_us.reserve(found.size());
    for (const Distance& each : found) sizes_us.push_back(std::abs(each.us));
    if (median(std::move(sizes_us)) > kWrongLockFrom * period_ns_ * kUsPerNs) ++score.wrong_locks;
  }
}

void AlignmentScores::add_to(MetricValues<double>& score) const {
  std::vector<double> disturbed;
  for (const std::vector<Frame>& frames : cameras_) {
    if (const auto found = disturbed_frames(frames)) {
      disturbed.push_back(static_cast<double>(*found));
    }
  }
  score.disturbed_frames = mean_of_existing(disturbed);
  if (cameras_.size() < 2) return;
  const std::vector<Pulse> complete = complete_pulses();
  add_spreads(complete, score);
  add_aligned(complete, score);
  add_distances(score);
}

}  // namespace simbench::evaluation
