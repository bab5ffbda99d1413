#include "algorithms/capture_alignment/phase_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simbench {
namespace {

constexpr double kNoiseGain = 1.0 / 32;
constexpr double kNoiseGainAtFirst = 0.25;
constexpr std::size_t kFew = 8;
constexpr double kSigmaOfMeanDistance = 1.2533;  // of a normal distribution
constexpr double kManyNoises = 4;
// Moves older than this, in frames, are in every frame that is still asked for.
constexpr std::uint32_t kOld = 256;

}  // namespace

PhaseLine::PhaseLine(Nanoseconds period, std::size_t window)
    : period_(period), window_(window), fit_(window) {}

double PhaseLine::weight() const {
  const auto n = static_cast<double>(std::min(frames_, window_));
  return n * (n * n - 1) / 12;
}

double PhaseLine::slope_ns() const {
  const double weights = weight() + known_weight_;
  if (weights == 0) return 0;
  return (weight() * line_.slope + known_weight_ * known_slope_ns_) / weights;
}

double PhaseLine::slope_sigma_ns() const {
  const double weights = weight() + known_weight_;
  if (weights == 0) return std::numeric_limits<double>::infinity();
  return kSigmaOfMeanDistance * noise_ns_ / std::sqrt(weights);
}

double PhaseLine::line_at(std::int64_t frame) const {
  Line line = line_;
  line.slope = slope_ns();
  return line.at(frame);
}

std::int64_t PhaseLine::moved_ns(std::uint32_t counter) const {
  std::int64_t sum = old_moves_ns_;
  for (const Move& move : moves_) {
    if (counter >= move.from) sum += move.by_ns;
  }
  return sum;
}

void PhaseLine::add(std::uint32_t counter, HostTime exposed) {
  if (!has_zero_) {
    has_zero_ = true;
    zero_counter_ = counter;
    const std::int64_t periods =
        floor_div(exposed.time_since_epoch().count() + period_.count() / 2, period_.count());
    zero_ = HostTime(periods * period_);
  }
  const std::int64_t n = frame_of(counter);
  const std::int64_t error_ns = (exposed - (zero_ + n * period_)).count() - moved_ns(counter);
  if (frames_ > 1) {
    const double distance_ns = static_cast<double>(error_ns) - line_at(n);
    recent_ns_[frames_ % kRecent] = distance_ns;
    // What lies far off is a move that nobody said, not noise.
    const double most_ns = frames_ < kFew ? std::abs(distance_ns) : kManyNoises * noise_ns_ + 1;
    const double found_ns = std::min(std::abs(distance_ns), most_ns);
    noise_ns_ += (found_ns - noise_ns_) * (frames_ < kOld / 8 ? kNoiseGainAtFirst : kNoiseGain);
  }
  fit_.push({.x = n, .y = error_ns});
  line_ = fit_.line();
  ++frames_;
  while (!moves_.empty() && moves_.front().from + kOld < counter) {
    old_moves_ns_ += moves_.front().by_ns;
    moves_.pop_front();
  }
}

void PhaseLine::move(std::uint32_t from_counter, Nanoseconds by) {
  moves_.push_back({from_counter, by.count()});
}

void PhaseLine::restart() {
  // No more than a full window tells, so that a rate that has changed is forgotten.
  const auto most = static_cast<double>(window_);
  known_slope_ns_ = slope_ns();
  known_weight_ = std::min(weight() + known_weight_, most * (most * most - 1) / 12);
  fit_ = LineWindow(window_);
  line_ = {};
  frames_ = 0;
  recent_ns_.fill(0);
}

void PhaseLine::forget() {
  restart();
  known_slope_ns_ = known_weight_ = 0;
}

HostTime PhaseLine::due(std::uint32_t counter) const {
  return zero_ + frame_of(counter) * period_ + grid_;
}

void PhaseLine::set_grid(HostTime due_then, std::uint32_t counter) {
  const Nanoseconds beside = due_then - due(counter);
  grid_ += beside - period_ * floor_div(beside.count(), period_.count());
  shift_grid(std::llround(error_ns(counter) / to_ns(period_)));
}

double PhaseLine::error_ns(std::uint32_t counter) const {
  if (frames_ == 0) return 0;
  return line_at(frame_of(counter)) + static_cast<double>(moved_ns(counter)) - to_ns(grid_);
}

bool PhaseLine::is_surprised(double least_ns) const {
  if (frames_ < 2 * kRecent) return false;
  const auto [low, high] = std::ranges::minmax(recent_ns_);
  const double limit_ns = std::max(least_ns, kManyNoises * noise_ns_);
  return low > limit_ns || high < -limit_ns;
}

}  // namespace simbench
