// Runs an estimator that must see the whole recording before its first stamp.
//
// Frames are held back (56 bytes each) until the capture has ended; then each source's estimator
// learns from all of them and stamps them, in order of delivery. An online estimator may be run
// this way too; it gives the stamps it would have given at once.
//
//   DeferredStamps deferred(sources);
//   deferred.add({.source = 3, .pulse = 225, .sample = sample});
//   deferred.stamp(make_estimator, [&](const DeferredFrame& frame, GlobalTime global) { ... });
#ifndef SIMBENCH_EVALUATION_SCORING_DEFERRED_STAMPS_H_
#define SIMBENCH_EVALUATION_SCORING_DEFERRED_STAMPS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "algorithms/device_time/device_time.h"

namespace simbench::evaluation {

struct DeferredFrame {
  std::uint32_t source = 0;
  std::int64_t pulse = 0;
  DeviceSample sample;
  GlobalTime delivered{};
};

using EstimatorFactory = std::function<std::unique_ptr<DeviceTimeEstimator>()>;

class DeferredStamps {
 public:
  explicit DeferredStamps(std::size_t sources) : sources_(sources) {}

  void add(const DeferredFrame& frame) { frames_.push_back(frame); }

  void add_poll(std::uint32_t source, const PollSample& poll) { polls_.emplace_back(source, poll); }
  void add_adjustment(std::uint32_t source, const ClockAdjustment& adjustment) {
    adjustments_.emplace_back(source, adjustment);
  }

  // Calls `stamped` for every frame, in the order they were added.
  void stamp(const EstimatorFactory& make,
             const std::function<void(const DeferredFrame&, GlobalTime)>& stamped) const;

 private:
  std::size_t sources_;
  std::vector<DeferredFrame> frames_;
  std::vector<std::pair<std::uint32_t, PollSample>> polls_;
  std::vector<std::pair<std::uint32_t, ClockAdjustment>> adjustments_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_DEFERRED_STAMPS_H_
