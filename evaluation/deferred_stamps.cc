#include "evaluation/deferred_stamps.h"

namespace simbench::evaluation {

void DeferredStamps::stamp(
    const EstimatorFactory& make,
    const std::function<void(const DeferredFrame&, GlobalTime)>& stamped) const {
  std::vector<std::vector<DeviceSample>> recordings(sources_);
  for (const DeferredFrame& frame : frames_) recordings[frame.source].push_back(frame.sample);

  std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators;
  estimators.reserve(sources_);
  for (const std::vector<DeviceSample>& recording : recordings) {
    estimators.push_back(make());
    if (!recording.empty()) estimators.back()->learn(recording);
  }
  for (const DeferredFrame& frame : frames_) {
    stamped(frame, estimators[frame.source]->stamp(frame.sample));
  }
}

}  // namespace simbench::evaluation
