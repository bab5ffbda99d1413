#include "watch/phase_track.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace simbench::watch {
double PhaseTrack::change_ms(double phase_ms, double period_ms) const {
  return std::remainder(phase_ms - place_ms_, period_ms);
}

double PhaseTrack::scatter_ms() const {
  if (steps_ms_.size() < 2) return evaluation::kNan;
  std::vector<double> sizes;
  for (const double step : steps_ms_) sizes.push_back(std::abs(step));
  return kSigmaOfMad * evaluation::median(std::move(sizes)) / std::sqrt(2.0);
}

double PhaseTrack::limit_ms(double period_ms) const {
  const double scatter = scatter_ms();
  return std::max(kMovedShare * period_ms, std::isnan(scatter) ? 0 : kMovedSigmas * scatter);
}

std::optional<PhaseMove> PhaseTrack::add(double phase_ms, double common_ms, double period_ms) {
  ++stretches_;
  if (std::isnan(last_ms_)) {
    place_ms_ = last_ms_ = phase_ms;
    return std::nullopt;
  }
  const double step_ms = std::remainder(phase_ms - last_ms_, period_ms);
  const double off_ms = std::remainder(change_ms(phase_ms, period_ms) - common_ms, period_ms);
  const double limit = limit_ms(period_ms);
  last_ms_ = phase_ms;
  if (!is_known()) {  // the place is the mean of the first stretches
    place_ms_ += off_ms / static_cast<double>(stretches_);
    steps_ms_.push_back(step_ms);
    return std::nullopt;
  }
  if (std::abs(off_ms) <= limit) {
    before_ms_ = off_ms;
    suspected_ms_.reset();
    steps_ms_.push_back(step_ms);
    if (steps_ms_.size() > kKept) steps_ms_.pop_front();
    return std::nullopt;
  }
  const bool is_sure =
      suspected_ms_ && std::abs(std::remainder(off_ms - *suspected_ms_, period_ms)) <= limit;
  const double first_ms = suspected_ms_.value_or(off_ms);
  suspected_ms_ = off_ms;
  if (!is_sure) return std::nullopt;
  const bool is_slip = std::abs(std::remainder(first_ms - before_ms_, period_ms)) > limit / 2;
  place_ms_ = std::remainder(place_ms_ + off_ms, period_ms);
  moved_ms_ += off_ms;
  suspected_ms_.reset();
  before_ms_ = 0;
  return PhaseMove{off_ms, is_slip};
}

void PhaseTrack::shift(double reference_ms, double period_ms) {
  place_ms_ = std::remainder(place_ms_ - reference_ms, period_ms);
  last_ms_ = std::remainder(last_ms_ - reference_ms, period_ms);
}

}  // namespace simbench::watch
