// Frames on their way to the scores: a block of them, and those kept until the capture has ended.
//
// A block has the frames that are treated alike, in order of delivery, as the stages want them: for
// device_time cameras and samples, for gathering the frames, whose stamps device_time tells.
//
// Estimators that must see the whole recording (DeviceTimeEstimator::offline) learn a camera's
// samples, which lie in one piece, and then stamp them; gathering wants all in order of delivery.
// Memory: 52 bytes a frame. Complexity: amortised O(1) a frame.
//
//   KeptFrames kept(/*cameras=*/18, /*frames=*/500);
//   kept.add(block);
//   bank.at(3).learn(kept.samples(3));
//   kept.replay([&](FrameBlock& again) { use(again); });
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "algorithms/gathering/gathering.h"

namespace simbench::evaluation {

class FrameBlock {
 public:
  // Empties it, with room for so many frames.
  void start(std::size_t room) {
    size_ = 0;
    if (room <= cameras_.size()) return;
    cameras_.resize(room);
    samples_.resize(room);
    stamps_.resize(room);
    frames_.resize(room);
  }
  void add(std::uint32_t camera, const DeviceSample& sample, std::int64_t pulse,
           GlobalTime delivered) {
    cameras_[size_] = camera;
    // Member by member: a copy of the whole would wait for the members that were just written.
    DeviceSample& kept = samples_[size_];
    kept.sensor = sample.sensor;
    kept.arrival = sample.arrival;
    kept.arrival_steady = sample.arrival_steady;
    kept.exposure_us = sample.exposure_us;
    GatherFrame& frame = frames_[size_++];
    frame.source = camera;
    frame.exposure_us = sample.exposure_us;
    frame.arrival = delivered;
    frame.sensor = sample.sensor;
    frame.tag = pulse;
  }
  void clear() { size_ = 0; }

  std::size_t size() const { return size_; }
  std::span<const std::uint32_t> cameras() const { return {cameras_.data(), size_}; }
  std::span<const DeviceSample> samples() const { return {samples_.data(), size_}; }
  std::span<const GatherFrame> frames() const { return {frames_.data(), size_}; }
  std::span<GatherFrame> frames() { return {frames_.data(), size_}; }
  std::span<GlobalTime> stamps() { return {stamps_.data(), size_}; }

 private:
  std::size_t size_ = 0;
  std::vector<std::uint32_t> cameras_;  // these have room for more
  std::vector<DeviceSample> samples_;
  std::vector<GlobalTime> stamps_;
  std::vector<GatherFrame> frames_;
};

class KeptFrames {
 public:
  struct Delivery {
    std::int64_t pulse = 0;
    GlobalTime delivered{};
  };

  // `frames` are expected of each camera; there may be more.
  KeptFrames(std::size_t cameras, std::size_t frames) : cameras_(cameras) {
    for (Camera& camera : cameras_) {
      camera.samples.reserve(frames);
      camera.deliveries.reserve(frames);
    }
    order_.reserve(cameras * frames);
  }

  void add(const FrameBlock& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      const GatherFrame& frame = block.frames()[i];
      Camera& camera = cameras_[frame.source];
      camera.samples.push_back(block.samples()[i]);
      camera.deliveries.push_back({frame.tag, frame.arrival});
    }
    order_.insert(order_.end(), block.cameras().begin(), block.cameras().end());
  }

  std::size_t cameras() const { return cameras_.size(); }
  std::span<const DeviceSample> samples(std::size_t camera) const {
    return cameras_[camera].samples;
  }
  std::span<const Delivery> deliveries(std::size_t camera) const {
    return cameras_[camera].deliveries;
  }

  // Calls use(FrameBlock&) with block after block of all frames, in order of delivery.
  template <class Use>
  void replay(Use use) const {
    constexpr std::size_t kFramesInBlock = 1024;
    FrameBlock block;
    std::vector<std::size_t> next(cameras_.size());
    for (std::size_t begin = 0; begin < order_.size(); begin += kFramesInBlock) {
      block.start(kFramesInBlock);
      for (std::size_t i = begin; i < std::min(begin + kFramesInBlock, order_.size()); ++i) {
        const std::uint32_t camera = order_[i];
        const std::size_t place = next[camera]++;
        const Delivery& delivery = cameras_[camera].deliveries[place];
        block.add(camera, cameras_[camera].samples[place], delivery.pulse, delivery.delivered);
      }
      use(block);
    }
  }

 private:
  struct Camera {
    std::vector<DeviceSample> samples;
    std::vector<Delivery> deliveries;
  };

  std::vector<Camera> cameras_;
  std::vector<std::uint32_t> order_;  // the camera of each frame
};

}  // namespace simbench::evaluation
