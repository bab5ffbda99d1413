#include "algorithms/host_sync/pulses/pulse_observer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace simbench {
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
  double sum_ns = 0;
  double variance = 0;
  int count = 0;
  for (const auto& [camera, train] : trains_) {
    const std::optional<Sighting> seen = train.train.nearest(when);
    if (!seen) continue;
    sum_ns += static_cast<double>((seen->at - when).count());
    variance += seen->sigma_ns * seen->sigma_ns;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Sighting{.at = when + from_ns(sum_ns / count), .sigma_ns = std::sqrt(variance) / count};
}

}  // namespace simbench
