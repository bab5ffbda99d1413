#include "algorithms/host_sync/pulses/pulse_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace simbench {
namespace {

constexpr double kStrangePart = 0.25;
// Each pass multiplies the error by the slope of the envelope.
constexpr int kPasses = 5;

// The standard error of the mean of values that differ by chance.
double standard_error(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  if (values.size() < 2) return 0;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (count - 1) / count);
}

}  // namespace

PulseTrain::PulseTrain(Settings settings)
    : settings_(settings),
      period_ns_(settings.period ? to_ns(*settings.period) : 0),
      all_(to_ns(settings.window)),
      groups_(Sighting::kGroups, Envelope(to_ns(settings.window))) {}

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
  for (Envelope& group : groups_) group.clear();
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
  groups_[group_of(number_)].add(x, y);
}

std::size_t PulseTrain::group_of(double number) const {
  const double pulses_of_block = std::max(1.0, std::round(kBlockNs / period_ns_));
  const double block = std::floor(number / pulses_of_block);
  return static_cast<std::size_t>(std::fmod(block, static_cast<double>(Sighting::kGroups)));
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
  if (!y) return std::nullopt;
  Sighting sighting{.at = zero_ + from_ns(x + *y)};
  for (std::size_t i = 0; i < Sighting::kGroups; ++i) {
    const std::optional<double> of_group = groups_[i].at(x);
    if (!of_group) return std::nullopt;
    sighting.groups_ns[i] = *of_group - *y;
  }
  sighting.sigma_ns = standard_error(sighting.groups_ns);
  return sighting;
}

namespace {

constexpr Nanoseconds kSecond{1'000'000'000};

}  // namespace

const char* port_name(PulseSource source) {
  switch (source) {
    case PulseSource::kFrames:
      return "frame feed (Host::frame_feed)";
    case PulseSource::kTrigger:
      return "trigger line (Host::pulse_input)";
    default:
      return "PPS line (Host::pulse_input)";
  }
}

PulseObserver::PulseObserver(Host& host, Settings settings)
    : host_(host), settings_(settings), train_settings_{.window = settings.window, .period = {}} {
  if (settings.source == PulseSource::kFrames) {
    feed_ = host.frame_feed();
  } else if (settings.source == PulseSource::kTrigger) {
    input_ = host.pulse_input(PulseLine::kTrigger);
  } else {
    input_ = host.pulse_input(PulseLine::kPps);
    train_settings_.period = kSecond;
  }
}

Task<void> PulseObserver::collect() {
  if (is_collecting_) co_return;
  is_collecting_ = true;
  if (feed_ != nullptr) co_await collect_frames();
  if (input_ != nullptr) co_await collect_pulses();
  is_collecting_ = false;
}

Task<void> PulseObserver::collect_frames() {
  while (true) {
    const std::optional<FrameArrival> frame = co_await feed_->next(host_.steady_clock().now());
    if (!frame) co_return;
    add(*frame);
  }
}

void PulseObserver::add(const FrameArrival& frame) {
  auto found = trains_.find(frame.camera);
  if (found == trains_.end()) {
    Train fresh{.train = PulseTrain(train_settings_),
                .first_arrival = frame.arrival_steady,
                .last_stamp_us = frame.sensor.us,
                .last_used_us = 0};
    found = trains_.emplace(frame.camera, std::move(fresh)).first;
  }
  Train& train = found->second;
  // The difference of the registers, as a signed number, is right across a wrap.
  const Microseconds step(static_cast<std::int32_t>(frame.sensor.us - train.last_stamp_us));
  train.last_stamp_us = frame.sensor.us;
  if (step.count() > 0) shortest_step_ = std::min<Nanoseconds>(shortest_step_, step);
  if (frame.arrival_steady - train.first_arrival < settings_.settle) return;
  const bool is_next_pulse =
      !group_.empty() && frame.arrival_steady - group_.front().arrival_steady > shortest_step_ / 2;
  if (is_next_pulse) group_.clear();
  group_.push_back(frame);
  if (group_.size() == trains_.size()) add_group();
}

void PulseObserver::add_group() {
  for (const FrameArrival& frame : group_) {
    Train& train = trains_.at(frame.camera);
    const Microseconds step(static_cast<std::int32_t>(frame.sensor.us - train.last_used_us));
    train.last_used_us = frame.sensor.us;
    train.train.add(step, frame.arrival_steady - Microseconds(frame.exposure_us));
  }
  group_.clear();
}

Task<void> PulseObserver::collect_pulses() {
  const auto found = trains_
                         .try_emplace(0, Train{.train = PulseTrain(train_settings_),
                                               .first_arrival = {},
                                               .last_stamp_us = 0,
                                               .last_used_us = 0})
                         .first;
  while (true) {
    const std::optional<PulseStamp> pulse = co_await input_->next(host_.steady_clock().now());
    if (!pulse) co_return;
    found->second.train.add(pulse->steady - last_pulse_, pulse->steady);
    last_pulse_ = pulse->steady;
  }
}

std::optional<Sighting> PulseObserver::middle() const {
  for (const auto& [camera, train] : trains_) {
    const std::optional<Sighting> middle = train.train.middle();
    if (middle) return nearest(middle->at);
  }
  return std::nullopt;
}

std::optional<Sighting> PulseObserver::nearest(SteadyTime when) const {
  std::vector<double> late_ns;
  late_ns.reserve(trains_.size());
  std::array<double, Sighting::kGroups> groups_ns{};
  for (const auto& [camera, train] : trains_) {
    const std::optional<Sighting> seen = train.train.nearest(when);
    if (!seen) continue;
    late_ns.push_back(to_ns(seen->at - when));
    for (std::size_t i = 0; i < Sighting::kGroups; ++i) groups_ns[i] += seen->groups_ns[i];
  }
  if (late_ns.empty()) return std::nullopt;
  const auto count = static_cast<double>(late_ns.size());
  for (double& group_ns : groups_ns) group_ns /= count;
  const double mean_ns = std::accumulate(late_ns.begin(), late_ns.end(), 0.0) / count;
  return Sighting{.at = when + from_ns(mean_ns),
                  .sigma_ns = std::hypot(standard_error(groups_ns), standard_error(late_ns)),
                  .groups_ns = groups_ns};
}

}  // namespace simbench
