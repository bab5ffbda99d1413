#include "algorithms/host_sync/ptp/sptp_servo.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace simbench {
namespace {

constexpr std::size_t kRemembered = 30;
constexpr int kMostSpikes = 15;
constexpr double kLeastSpikeNs = 15'000;
constexpr double kSigmas = 3;
constexpr double kDriftPpb = 20;
constexpr double kStableNs = 100;

void keep(std::deque<double>& values, double value) {
  values.push_back(value);
  if (values.size() > kRemembered) values.pop_front();
}

double mean_of(const std::deque<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double sigma_about(double mean, const std::deque<double>& values) {
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

bool SptpPathDelay::is_discarded(Nanoseconds delay) const {
  if (taken_ == 0) return false;
  if (delay < settings_.discard_below) return true;
  const Nanoseconds most = from_ns(settings_.multiplier * to_ns(path_delay_));
  return delay > settings_.discard_from && delay > most && most > settings_.discard_below &&
         taken_ >= settings_.length;
}

Nanoseconds SptpPathDelay::offset(const SptpExchange& exchange) {
  const Nanoseconds from_server = exchange.from_server();
  const Nanoseconds delay = (from_server + exchange.to_server()) / 2;
  if (!is_discarded(delay)) {
    path_delay_ = median_.add(delay);
    ++taken_;
  }
  return from_server - path_delay_;
}

SptpServo::Answer SptpServo::sample(double offset_ns, std::int64_t local_ns, SteadyTime now) {
  if (is_spike(offset_ns, now)) return hold();
  const ServoAnswer answer = pi_.sample(offset_ns, local_ns, 1);
  switch (answer.state) {
    case ServoState::kUnlocked:
      return {};
    case ServoState::kJump:
      return {.action = Action::kStep, .ppb = answer.ppb, .is_locked = false};
    case ServoState::kLocked:
      break;
  }
  remember(offset_ns, answer.ppb);
  spikes_ = 0;
  last_correction_ = now;
  return {.action = Action::kSetFrequency, .ppb = answer.ppb, .is_locked = true};
}

bool SptpServo::is_spike(double offset_ns, SteadyTime now) {
  if (!pi_.has_frequency()) return false;
  if (spikes_ >= kMostSpikes) {
    pi_.forget();
    offsets_ns_.clear();
    frequencies_ppb_.clear();
    spikes_ = 0;
    return true;
  }
  if (offsets_ns_.size() < kRemembered) return false;
  const double waited_s = std::round(to_seconds(now - last_correction_));
  const double most_ns =
      kSigmas * offset_sigma_ns_ + waited_s * (kSigmas * frequency_sigma_ppb_ + kDriftPpb);
  if (std::abs(offset_ns) <= std::max(most_ns, kLeastSpikeNs)) return false;
  ++spikes_;
  return true;
}

void SptpServo::remember(double offset_ns, double ppb) {
  keep(offsets_ns_, offset_ns);
  offset_sigma_ns_ = sigma_about(mean_of(offsets_ns_), offsets_ns_);
  if (std::abs(offset_ns) > kStableNs) return;
  keep(frequencies_ppb_, ppb);
  if (frequencies_ppb_.size() == kRemembered) mean_ppb_ = mean_of(frequencies_ppb_);
  frequency_sigma_ppb_ = sigma_about(mean_ppb_, frequencies_ppb_);
}

}  // namespace simbench
