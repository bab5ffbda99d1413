// The stamps that the cameras of a capture take of its frames, with their own clocks.
//
// The cameras' half of a world (sim/rig/camera_world.h) is the same whenever a capture starts. The
// cameras' oscillators are functions of true time, so their stamps are not: each start has its own.
// Stamps are taken once and kept as long as their periods are.
//
//   CameraStamps stamps(scenario, camera_world, capture_start);
//   const std::span<const FrameStamps> of_frames = stamps.of_period(3, *camera_world.period(3));
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/ports/time.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/camera/device_clock.h"
#include "sim/rig/camera_world.h"

namespace simbench::sim {

struct FrameStamps {
  DeviceStamp sensor{};  // middle of the exposure
  DeviceStamp frame{};   // begin of the readout, which is that of its first row
};

class CameraStamps {
 public:
  // `world` must outlive this.
  CameraStamps(const scenarios::Scenario& scenario, const CameraWorld& world, TrueTime start)
      : world_(world), start_(start), clocks_(device_clocks(scenario, world.seed(), start)) {}

  TrueTime start() const { return start_; }
  const std::vector<DeviceClock>& clocks() const { return clocks_; }

  // The stamps of a period's frames, by their places, until the next call. Periods come in order;
  // those that the world keeps may come again.
  std::span<const FrameStamps> of_period(std::size_t number, const CameraPeriod& period) {
    if (number < kept_.size()) return kept_[number];
    if (!world_.is_whole()) kept_.clear();
    std::vector<FrameStamps>& stamps = world_.is_whole() ? kept_.emplace_back() : passing_;
    stamps.clear();
    stamps.reserve(period.frames.size());
    const std::vector<SimFrame>& frames = period.frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (i + kAhead < frames.size()) clocks_[frames[i + kAhead].camera].prefetch();
      stamps.push_back(stamps_of(frames[i]));
    }
    return stamps;
  }

  DeviceStamp of_poll(const CameraPoll& poll) {
    return clocks_[poll.camera].stamp(date(poll.read), 0);
  }

 private:
  static constexpr std::size_t kAhead = 16;  // frames, for the cache

  TrueTime date(TrueTime since_start) const { return start_ + since_start.time_since_epoch(); }

  FrameStamps stamps_of(const SimFrame& frame) {
    if (frame.fate != FrameFate::kDelivered) return {};
    DeviceClock& clock = clocks_[frame.camera];
    return {.sensor = clock.stamp(date(frame.mid_exposure()), frame.stamp_noise_ns),
            .frame = clock.stamp(date(frame.readout_start), frame.stamp_noise_ns)};
  }

  const CameraWorld& world_;
  TrueTime start_;
  std::vector<DeviceClock> clocks_;
  std::vector<std::vector<FrameStamps>> kept_;  // by period, while the world is whole
  std::vector<FrameStamps> passing_;
};

}  // namespace simbench::sim
