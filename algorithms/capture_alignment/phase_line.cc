#include "algorithms/capture_alignment/phase_line.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kNoiseGain = 1.0 / 32;
constexpr double kNoiseGainAtFirst = 0.25;
constexpr std::size_t kFew = 8;
constexpr double kManyNoises = 4;
// Moves older than this, in frames, are in every frame that is still asked for.
constexpr std::uint32_t kOld = 256;

}  // namespace

PhaseLine::PhaseLine(Nanoseconds period, std::size_t window)
    : period_(period), window_(window), fit_(window) {}

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
  const std::int64_t n = counter - zero_counter_;
  const std::int64_t error_ns = (exposed - (zero_ + n * period_)).count() - moved_ns(counter);
  if (frames_ > 1) {
    const double distance_ns = static_cast<double>(error_ns) - line_.at(n);
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
  fit_ = LineWindow(window_);
  line_ = {};
  frames_ = 0;
  recent_ns_.fill(0);
}

double PhaseLine::error_ns(std::uint32_t counter) const {
  if (frames_ == 0) return 0;
  const auto n = static_cast<std::int64_t>(counter) - static_cast<std::int64_t>(zero_counter_);
  return line_.at(n) + static_cast<double>(moved_ns(counter));
}

bool PhaseLine::is_surprised(double least_ns) const {
  if (frames_ < 2 * kRecent) return false;
  const auto [low, high] = std::ranges::minmax(recent_ns_);
  const double limit_ns = std::max(least_ns, kManyNoises * noise_ns_);
  return low > limit_ns || high < -limit_ns;
}

}  // namespace simbench
