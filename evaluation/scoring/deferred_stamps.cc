#include "evaluation/scoring/deferred_stamps.h"

namespace simbench::evaluation {

void DeferredStamps::stamp(
    const EstimatorFactory& make,
    const std::function<void(const DeferredFrame&, GlobalTime)>& stamped) const {
  std::vector<std::vector<DeviceSample>> recordings(sources_);
  for (const DeferredFrame& frame : frames_) recordings[frame.source].push_back(frame.sample);

  std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators;
  estimators.reserve(sources_);
  for (std::size_t source = 0; source < sources_; ++source) estimators.push_back(make());
  for (const auto& [source, adjustment] : adjustments_) {
    estimators[source]->on_adjustment(adjustment);
  }
  for (const auto& [source, poll] : polls_) estimators[source]->on_poll(poll);
  for (std::size_t source = 0; source < sources_; ++source) {
    if (!recordings[source].empty()) estimators[source]->learn(recordings[source]);
  }
  for (const DeferredFrame& frame : frames_) {
    stamped(frame, estimators[frame.source]->stamp(frame.sample));
  }
}

}  // namespace simbench::evaluation
