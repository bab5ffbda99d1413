#include "sim/camera/steered_sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace simbench::sim {
namespace {

constexpr std::size_t kReadoutsKept = 64;  // more than any latency

}  // namespace

SteeredSensor::SteeredSensor(const SteeredSensorSettings& settings, OscillatorModel oscillator,
                             RandomStream draws, TrueTime start, TrueTime oscillator_zero)
    : settings_(settings),
      oscillator_(std::move(oscillator)),
      draws_(std::move(draws)),
      zero_(oscillator_zero.time_since_epoch()),
      phase_(draws_.uniform()),
      exposure_(settings.limits.exposure),
      lengths_(settings.limits, settings.insert_stretches) {
  restart(start, start);
}

double SteeredSensor::device_ns(TrueTime at) const {
  return static_cast<double>(at.time_since_epoch().count()) + oscillator_.deviation_ns(at + zero_);
}

// Two steps of a fixed point, whose error falls by the frequency error at each.
TrueTime SteeredSensor::true_time(double device, TrueTime near) const {
  TrueTime at = near;
  for (int step = 0; step < 3; ++step) at += from_ns(device - device_ns(at));
  return at;
}

Nanoseconds SteeredSensor::exposure_of(std::int64_t frame) const {
  return lengths_.exposure(frame).value_or(exposure_);
}

// The time from the readout of that frame to the next; the next exposure has to fit into it.
Nanoseconds SteeredSensor::length_after(std::int64_t frame) const {
  const Nanoseconds wanted = lengths_.of(frame);
  const Nanoseconds step = settings_.limits.granularity;
  const Nanoseconds least = exposure_of(frame + 1) + step;
  if (wanted >= least) return wanted;
  return step * -floor_div(-least.count(), step.count());
}

void SteeredSensor::plan_next() {
  if (settings_.is_ideal) return plan_ideal();
  const Nanoseconds length = length_after(frame_);
  next_readout_device_ns_ = readout_device_ns_ + to_ns(length);
  next_readout_ = true_time(next_readout_device_ns_, readout_ + length);
  next_exposure_ = next_readout_ - exposure_of(frame_ + 1);
}

// The middle of the exposure, of all its rows, is due at an instant, and comes with the granule
// that is nearest.
void SteeredSensor::plan_ideal() {
  const Nanoseconds after_middle = (exposure_ - settings_.readout) / 2;
  const auto since_first =
      static_cast<double>((next_readout_ - after_middle - settings_.first_due).count());
  const double slot = std::floor(since_first / settings_.period_ns + 0.5) + 1;
  const double due_ns = std::max(slot, 0.0) * settings_.period_ns;
  const TrueTime due = settings_.first_due + from_ns(due_ns) + after_middle;
  const auto step = static_cast<double>(settings_.limits.granularity.count());
  const double granule = std::round(device_ns(due) / step - phase_) + phase_;
  next_readout_device_ns_ = granule * step;
  next_readout_ = true_time(next_readout_device_ns_, due);
  next_exposure_ = next_readout_ - exposure_;
}

// Frames from now on begin anew with an exposure at that time.
void SteeredSensor::restart(TrueTime at, TrueTime made_until) {
  next_exposure_ = std::max(at, made_until);
  next_readout_ = next_exposure_ + exposure_of(frame_ + 1);
  next_readout_device_ns_ = device_ns(next_readout_);
  if (settings_.is_ideal) plan_ideal();
}

Exposure SteeredSensor::expose(Nanoseconds exposure) {
  ++frame_;
  exposure_ = exposure;
  readout_ = next_readout_;
  readout_device_ns_ = next_readout_device_ns_;
  readouts_.push_back(readout_);
  if (readouts_.size() > kReadoutsKept) readouts_.pop_front();
  lengths_.forget_before(frame_);
  const TrueTime read = readout_ + from_ns(draws_.normal(settings_.jitter_sigma_ns));
  const Exposure made{kNoPulse, read - exposure_of(frame_), read + settings_.readout};
  plan_next();
  return made;
}

void SteeredSensor::latch(const FrameCommand& command, TrueTime at, TrueTime made_until) {
  if (settings_.is_ideal) return;
  if (command.kind == FrameControlKind::kStartAt) return restart(command.at, made_until);
  const auto begun = std::upper_bound(readouts_.begin(), readouts_.end(), at);
  const std::int64_t in_progress = frame_ - (readouts_.end() - begun);
  const auto latency = static_cast<std::int64_t>(settings_.limits.latency_frames);
  std::int64_t frame = std::max(in_progress + latency, frame_);
  const Nanoseconds length = lengths_.wanted(command.kind, command.length, frame);
  if (frame == frame_ && readout_ + length - exposure_ < made_until) ++frame;
  lengths_.set(command.kind, length, frame);
  if (command.kind == FrameControlKind::kInsertFrame) {
    for (std::int64_t i = 0; i < settings_.insert_stretches; ++i) {
      lengths_.lengthen(frame + i, from_ns(draws_.normal(settings_.insert_noise_sigma_ns)));
    }
  }
  if (frame == frame_) plan_next();
}

}  // namespace simbench::sim
