#include "algorithms/host_sync/chrony/chrony_reference.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kMeasuredWeight = 3;
constexpr double kMinSlewTime = 1;  // s

}  // namespace

ChronyCorrection ChronyReference::update(const ChronyEstimate& estimate, double now_s,
                                         double left_s) {
  ChronyCorrection correction;
  correction.offset_s = estimate.offset_s + (now_s - estimate.at_s) * estimate.frequency;
  correction.frequency = change_of_frequency(estimate);
  const double interval_s = now_s - last_update_s_.value_or(now_s);
  last_update_s_ = now_s;
  const double size_s = std::abs(left_s + correction.offset_s);
  if (size_s > 0) {
    const double area = settings_.correction_ratio * interval_s * estimate.offset_sd_s;
    const double time_s = std::max(area / size_s, kMinSlewTime);
    correction.slew_rate = std::min(size_s / time_s, settings_.max_slew_rate);
  }
  return correction;
}

double ChronyReference::change_of_frequency(const ChronyEstimate& estimate) {
  double gain = 0;
  if (estimate.skew <= settings_.max_update_skew) {
    const double present = kMeasuredWeight * skew_ * skew_;
    gain = present / (present + estimate.skew * estimate.skew);
  }
  const double before = frequency_;
  frequency_ = std::clamp(frequency_ + gain * estimate.frequency, -kMaxFrequency, kMaxFrequency);
  const double change = frequency_ - before;
  const double disagreement = std::hypot(std::sqrt(1 - gain) * gain * estimate.frequency,
                                         std::sqrt(gain) * (1 - gain) * estimate.frequency);
  skew_ += gain * (estimate.skew - skew_) + disagreement;
  return change;
}

}  // namespace simbench
