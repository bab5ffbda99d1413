// The stage device_time over all cameras of a capture: gives estimators what they learn from, and
// frames their global stamps.
//
// Device stamps wrap after 71 minutes; they are unwrapped here, frames and polls of a camera
// together, in order of delivery. The stamps of a relative estimator lack one anchor for all
// cameras: the arrival of the first frame of the master's first camera, or of the first frame of
// all if that camera has none. It is known before the first complete set, which has a frame of that
// camera.
//
//   Stamping stamping(layout,
//                     [](std::size_t) { return make_regression(RegressionWindow{30}); });
//   const DeviceTime sensor = stamping.unwrap(record.camera, record.sensor);
//   stamping.stamp(block);
//   table.shift(stamping.shift());
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/device_time/unwrap.h"
#include "evaluation/scoring/kept_frames.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class Stamping {
 public:
  // An empty factory: the oracle, the true time on the own host.
  Stamping(const RigLayout& layout, const EstimatorFactory& make);

  // Gives another bank all that estimators learn from, except frames; it must outlive this.
  void inform(EstimatorBank& bank) { informed_.push_back(&bank); }

  bool is_oracle() const { return bank_ == nullptr; }
  // Stamps when the capture has ended.
  bool is_offline() const { return offline_; }
  // Wants the frames of the warm-up.
  bool stamps_warm_up() const { return stamp_warm_up_; }

  DeviceTime unwrap(std::uint32_t camera, DeviceStamp stamp) {
    return unwrappers_[camera].unwrap(stamp);
  }
  PollSample sample_of(const DevicePoll& poll) {
    return {unwrap(poll.camera, poll.device), poll.t0, poll.t1, poll.t0_steady, poll.t1_steady};
  }
  // Each frame of the scored stream, for the anchor.
  void note(const FrameRecord& frame) {
    if (anchor_) return;
    if (!first_arrival_) first_arrival_ = frame.arrival;
    if (anchor_camera_ == frame.camera) anchor_ = frame.arrival;
  }
  // Adjustments, polls and sightings.
  void on_event(const RecordingEvent& event);

  // Sets the stamps of the block. Not for an oracle, nor before learn() where it is offline.
  void stamp(FrameBlock& block) { bank_->stamp(block.cameras(), block.samples(), block.stamps()); }
  // An offline estimator learns the whole capture.
  void learn(const KeptFrames& kept);

  // What the stamps lack: the anchor of a relative estimator, else nothing.
  Nanoseconds shift() const;

 private:
  template <class Inform>
  void inform_of(std::uint32_t camera, const Inform& inform) {
    for (EstimatorBank* bank : informed_) inform(bank->at(camera));
  }

  std::vector<DeviceStampUnwrapper> unwrappers_;  // by camera
  std::vector<std::vector<std::uint32_t>> cameras_of_host_;
  std::unique_ptr<EstimatorBank> bank_;  // null: the oracle
  std::vector<EstimatorBank*> informed_;
  bool relative_ = false;
  bool offline_ = false;
  bool stamp_warm_up_ = false;
  std::optional<std::uint32_t> anchor_camera_;  // the master's first
  std::optional<HostTime> anchor_;
  std::optional<HostTime> first_arrival_;
};

}  // namespace simbench::evaluation
