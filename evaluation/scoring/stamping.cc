#include "evaluation/scoring/stamping.h"

#include <variant>

namespace simbench::evaluation {
namespace {

std::optional<std::uint32_t> first_camera_of_master(const RigLayout& layout) {
  for (std::size_t camera = 0; camera < layout.cameras.size(); ++camera) {
    if (layout.cameras[camera].host == 0) return static_cast<std::uint32_t>(camera);
  }
  return std::nullopt;
}

}  // namespace

Stamping::Stamping(const RigLayout& layout, const EstimatorFactory& make)
    : unwrappers_(layout.cameras.size()), anchor_camera_(first_camera_of_master(layout)) {
  for (std::uint32_t camera = 0; camera < layout.cameras.size(); ++camera) {
    const std::uint32_t host = layout.cameras[camera].host;
    if (host >= cameras_of_host_.size()) cameras_of_host_.resize(host + 1);
    cameras_of_host_[host].push_back(camera);
  }
  if (!make || layout.cameras.empty()) return;
  bank_ = make_bank(make, layout.cameras.size());
  inform(*bank_);
  const DeviceTimeEstimator& any = bank_->at(0);
  relative_ = any.relative();
  offline_ = any.offline();
  stamp_warm_up_ = !offline_ && (relative_ || any.from_first_frame());
}

void Stamping::on_event(const RecordingEvent& event) {
  if (const auto* adjustment = std::get_if<ClockAdjustment>(&event)) {
    if (adjustment->host >= cameras_of_host_.size()) return;  // a host without cameras
    for (const std::uint32_t camera : cameras_of_host_[adjustment->host]) {
      inform_of(camera, [&](DeviceTimeEstimator& each) { each.on_adjustment(*adjustment); });
    }
  } else if (const auto* poll = std::get_if<DevicePoll>(&event)) {
    const PollSample sample = sample_of(*poll);
    inform_of(poll->camera, [&](DeviceTimeEstimator& each) { each.on_poll(sample); });
  } else if (const auto* sighting = std::get_if<LedSighting>(&event)) {
    const LedSample sample = {unwrap(sighting->camera, sighting->sensor), sighting->middle()};
    inform_of(sighting->camera, [&](DeviceTimeEstimator& each) { each.on_led_sighting(sample); });
  }
}

void Stamping::learn(const KeptFrames& kept) {
  for (std::size_t camera = 0; camera < kept.cameras(); ++camera) {
    if (!kept.samples(camera).empty()) bank_->at(camera).learn(kept.samples(camera));
  }
}

Nanoseconds Stamping::shift() const {
  if (!relative_ || !first_arrival_) return Nanoseconds::zero();
  return anchor_.value_or(*first_arrival_).time_since_epoch();
}

}  // namespace simbench::evaluation
