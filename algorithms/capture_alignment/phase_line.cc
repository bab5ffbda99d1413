#include "algorithms/capture_alignment/phase_line.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kNoiseGain = 1.0 / 32;
constexpr double kNoiseGainAtFirst = 0.25;
constexpr std::size_t kFew = 8;
constexpr double kLeastVariance = 1;             // ns^2: stamps are whole nanoseconds
constexpr double kSigmaOfMeanDistance = 1.2533;  // of a normal distribution
constexpr double kManyNoises = 4;
// Moves older than this, in frames, are in every frame that is still asked for.
constexpr std::uint32_t kOld = 256;

// Sum of the squared distances of n successive frames from their middle.
double squared_distances(std::size_t frames) {
  const auto n = static_cast<double>(frames);
  return n * (n * n - 1) / 12;
}

}  // namespace

PhaseLine::PhaseLine(Nanoseconds period, std::size_t window)
    : period_(period), window_(window), fit_(window) {}

// Few frames do not tell their noise.
double PhaseLine::noise_for_slope_ns() const {
  return frames_ < kFew ? std::max(noise_ns_, known_noise_ns_) : noise_ns_;
}

double PhaseLine::precision() const {
  const double sigma_ns = kSigmaOfMeanDistance * noise_for_slope_ns();
  return squared_distances(std::min(frames_, window_)) / (sigma_ns * sigma_ns + kLeastVariance);
}

double PhaseLine::old_precision() const {
  const double filled = static_cast<double>(frames_) / static_cast<double>(window_);
  return known_precision_ * std::max(0.0, 1 - filled);
}

double PhaseLine::slope_ns() const {
  const double sum = precision() + old_precision();
  if (sum == 0) return 0;
  return (precision() * line_.slope + old_precision() * known_slope_ns_) / sum;
}

double PhaseLine::slope_sigma_ns() const { return 1 / std::sqrt(precision() + old_precision()); }

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
  const double noise_ns = noise_for_slope_ns();
  const double precision_of_both = precision() + old_precision();
  known_slope_ns_ = slope_ns();
  known_precision_ = precision_of_both;
  known_noise_ns_ = noise_ns;
  noise_ns_ = 0;
  fit_ = LineWindow(window_);
  line_ = {};
  frames_ = 0;
  recent_ns_.fill(0);
}

void PhaseLine::forget() {
  restart();
  known_slope_ns_ = known_precision_ = 0;
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
