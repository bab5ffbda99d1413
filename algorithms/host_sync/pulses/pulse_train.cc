#include "algorithms/host_sync/pulses/pulse_train.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kStrangePart = 0.25;
// Each pass multiplies the error by the slope of the envelope.
constexpr int kPasses = 5;

}  // namespace

PulseTrain::PulseTrain(Settings settings)
    : settings_(settings),
      period_ns_(settings.period ? to_ns(*settings.period) : 0),
      all_(to_ns(settings.window)),
      even_(to_ns(settings.window)),
      odd_(to_ns(settings.window)) {}

std::optional<Nanoseconds> PulseTrain::period() const {
  if (period_ns_ <= 0) return std::nullopt;
  return from_ns(period_ns_);
}

void PulseTrain::restart() {
  first_.clear();
  period_ns_ = settings_.period ? to_ns(*settings_.period) : 0;
  has_last_ = false;
  number_ = 0;
  strange_ = 0;
  pulses_ = 0;
  all_.clear();
  even_.clear();
  odd_.clear();
}

void PulseTrain::add(Nanoseconds step, SteadyTime seen) {
  if (period_ns_ > 0) {
    add_numbered(step, seen);
    return;
  }
  if (!first_.empty() && step.count() <= 0) return;
  first_.emplace_back(step, seen);
  if (first_.size() > kFirstSteps) find_period();
}

void PulseTrain::find_period() {
  std::vector<Nanoseconds> steps;
  for (std::size_t i = 1; i < first_.size(); ++i) steps.push_back(first_[i].first);
  std::sort(steps.begin(), steps.end());
  period_ns_ = to_ns(steps[steps.size() / 2]);
  for (const auto& [step, seen] : first_) add_numbered(step, seen);
  first_.clear();
}

void PulseTrain::add_numbered(Nanoseconds step, SteadyTime seen) {
  if (has_last_) {
    if (step.count() <= 0) return;
    const double periods = to_ns(step) / period_ns_;
    const double whole = std::max(1.0, std::round(periods));
    strange_ = std::abs(periods - whole) > kStrangePart ? strange_ + 1 : 0;
    if (strange_ >= kStrangeSteps) {
      restart();
      return;
    }
    number_ += whole;
  } else {
    has_last_ = true;
    zero_ = seen;
  }
  ++pulses_;
  const double x = number_ * period_ns_;
  const double y = to_ns(seen - zero_) - x;
  all_.add(x, y);
  (std::fmod(number_, 2) == 0 ? even_ : odd_).add(x, y);
}

std::optional<Sighting> PulseTrain::middle() const {
  if (pulses_ < kFewestPulses) return std::nullopt;
  const double middle_x = all_.vertices().back().x - all_.span() / 2;
  return at_number(std::round(middle_x / period_ns_));
}

std::optional<Sighting> PulseTrain::nearest(SteadyTime when) const {
  if (pulses_ < kFewestPulses) return std::nullopt;
  // x + y(x) = when. The period is known to some percent, which is then the slope of y.
  const double wanted = to_ns(when - zero_);
  const std::vector<Envelope::Point>& hull = all_.vertices();
  double x = wanted - hull.back().y;
  for (int pass = 0; pass < kPasses; ++pass) {
    x = wanted - *all_.at(std::clamp(x, hull.front().x, hull.back().x));
  }
  return at_number(std::round(x / period_ns_));
}

std::optional<Sighting> PulseTrain::at_number(double number) const {
  const double x = number * period_ns_;
  const std::optional<double> y = all_.at(x);
  const std::optional<double> even = even_.at(x);
  const std::optional<double> odd = odd_.at(x);
  if (!y || !even || !odd) return std::nullopt;
  return Sighting{.at = zero_ + from_ns(x + *y), .sigma_ns = std::abs(*even - *odd) / 2};
}

}  // namespace simbench
