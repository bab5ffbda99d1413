#include "watch/clock_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "evaluation/stability/log_stability.h"
#include "evaluation/stability/time_error.h"
#include "evaluation/statistics/statistics.h"
#include "reports/text/time_text.h"
#include "watch/phase_track.h"

namespace simbench::watch {
namespace {

using evaluation::ClockLogPoint;

constexpr std::size_t kNeighbours = 33;          // differences that a step is compared with
constexpr std::size_t kLearnedDifferences = 16;  // before any is judged
constexpr std::size_t kOutliers = 2;             // of these, one that comes and goes

double log_seconds(const ClockLogPoint& point) {
  return std::chrono::duration<double>(point.time).count();
}

// How far differences lie from the usual one. Where most of them are alike (a clock of coarse
// steps, a sawtooth), the median says too little; the mean, without the few largest, does not.
double scatter_of(const std::vector<double>& differences, double usual) {
  std::vector<double> distances;
  distances.reserve(differences.size());
  for (const double each : differences) distances.push_back(std::abs(each - usual));
  std::ranges::sort(distances);
  const std::size_t kept = distances.size() - std::min(kOutliers, distances.size() / 4);
  const double sum = std::accumulate(distances.begin(),
                                     distances.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
  return std::max(kSigmaOfMad * distances[distances.size() / 2], sum / static_cast<double>(kept));
}

}  // namespace

ClockWatch::ClockWatch(std::string subject, std::optional<double> limit_ms)
    : subject_(std::move(subject)), limit_ms_(limit_ms) {}

double ClockWatch::error_ms() const {
  return kept_.empty() ? evaluation::kNan : 1000 * kept_.back().error_s;
}

double ClockWatch::last_s() const {
  return kept_.empty() ? evaluation::kNan : log_seconds(kept_.back());
}

void ClockWatch::begin_anew() { fresh_ = 0; }

std::vector<WatchEvent> ClockWatch::add(const std::vector<ClockLogPoint>& points) {
  for (const ClockLogPoint& point : points) add_point(point);
  return std::exchange(events_, {});
}

void ClockWatch::add_point(const ClockLogPoint& point) {
  if (!kept_.empty() && point.time < kept_.back().time) fresh_ = 0;
  kept_.push_back(point);
  if (kept_.size() > kKeptErrors) kept_.pop_front();
  fresh_ = std::min(fresh_ + 1, kept_.size());
  ++samples_;
  look_for_step();
  look_at_limit();
}

// Whether the difference before the last one was a step.
void ClockWatch::look_for_step() {
  const std::size_t differences = std::min(fresh_ - 1, kNeighbours + 2);
  if (differences < kLearnedDifferences) return;
  const auto error = [&](std::size_t back) { return kept_[kept_.size() - 1 - back].error_s; };
  std::vector<double> before;
  for (std::size_t back = 2; back < differences; ++back) {
    before.push_back(error(back) - error(back + 1));
  }
  const double usual = evaluation::median(before);
  const double scatter = scatter_of(before, usual);
  const double jump = error(1) - error(2) - usual;
  const double after = error(0) - error(1) - usual;
  if (!(std::abs(jump) > evaluation::kStepFactor * scatter) || jump == 0) return;
  // An outlier that goes is none, and neither is its going.
  const double before_it = error(2) - error(3) - usual;
  if (std::abs(jump + before_it) < std::abs(jump) / 2) return;
  const double stays = jump + after;  // what the next one leaves of it
  if (std::abs(stays) < std::abs(jump) / 2 || stays * jump < 0) return;
  ++steps_;
  events_.push_back({.kind = "clock_step",
                     .subject = subject_,
                     .at_s = log_seconds(kept_[kept_.size() - 2]),
                     .text = fmt::format("{} stepped by {}{}", subject_, jump > 0 ? "+" : "-",
                                         reports::time_text(1000 * std::abs(jump)))});
}

void ClockWatch::look_at_limit() {
  if (!limit_ms_) return;
  const bool is_beyond = std::abs(error_ms()) > *limit_ms_;
  within_ = is_beyond ? 0 : within_ + 1;
  if (is_off_ ? within_ < kBackSamples : !is_beyond) return;
  is_off_ = !is_off_;
  events_.push_back({.kind = "clock_off",
                     .subject = subject_,
                     .at_s = last_s(),
                     .is_alarm = is_off_,
                     .text = is_off_ ? fmt::format("{} is off by {}, more than {}", subject_,
                                                   reports::time_text(std::abs(error_ms())),
                                                   reports::time_text(*limit_ms_))
                                     : fmt::format("{} is within {} again", subject_,
                                                   reports::time_text(*limit_ms_))});
}

std::optional<evaluation::Stability> ClockWatch::stability() const {
  if (kept_.size() <= static_cast<std::size_t>(evaluation::kFewestDifferences)) return std::nullopt;
  evaluation::LogPoints log{.points = {kept_.begin(), kept_.end()}};
  for (std::size_t i = 1; i < log.points.size(); ++i) {
    if (log.points[i].time < log.points[i - 1].time) log.segments.push_back(i);
  }
  return evaluation::stability_of(evaluation::evenly_spaced(log, std::nullopt).series);
}

std::optional<evaluation::TimeErrorSummary> ClockWatch::time_error() const {
  if (kept_.empty()) return std::nullopt;
  evaluation::TimeErrorPiece all;
  all.x_s.reserve(kept_.size());
  for (const ClockLogPoint& point : kept_) all.x_s.push_back(point.error_s);
  return evaluation::time_error_of({.interval_s = 1, .pieces = {std::move(all)}});
}

}  // namespace simbench::watch
