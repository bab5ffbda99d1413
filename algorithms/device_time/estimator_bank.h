// The estimators of many cameras, one for each, which stamp frames by the block.
//
// A stamp is the same here as from the estimator alone. A bank is quicker: its estimators are of
// one type and lie side by side in memory, and a block costs one virtual call. An estimator has one
// by its base class, if a copy of a fresh one is as good as another fresh one:
//
//   class Latest final : public Banked<Latest> {
//    public:
//     GlobalTime stamp(const DeviceSample& sample) override {
//       return newest_ = std::max(newest_, GlobalTime(sample.arrival.time_since_epoch()));
//     }
//    private:
//     GlobalTime newest_ = GlobalTime::min();
//   };
//
// Any other estimator works too, at the price of a virtual call for each frame.
//
//   auto bank = make_bank([](std::size_t) { return make_regression(RegressionWindow{30}); },
//                         /*cameras=*/18);
//   bank->stamp(cameras, frames, global);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/device_time/device_time.h"

namespace simbench {

// Makes the estimator of this camera.
using EstimatorFactory = std::function<std::unique_ptr<DeviceTimeEstimator>(std::size_t camera)>;

class EstimatorBank {
 public:
  virtual ~EstimatorBank() = default;
  virtual DeviceTimeEstimator& at(std::size_t camera) = 0;
  // stamps[i] = at(cameras[i]).stamp(samples[i]), in order. All three have the same length.
  virtual void stamp(std::span<const std::uint32_t> cameras, std::span<const DeviceSample> samples,
                     std::span<GlobalTime> stamps) = 0;
};

// A bank of the estimators that the factory makes, for at least one camera.
std::unique_ptr<EstimatorBank> make_bank(const EstimatorFactory& make, std::size_t cameras);

template <class Estimator>
class BankOf final : public EstimatorBank {
 public:
  BankOf(const Estimator& fresh, std::size_t cameras) : estimators_(cameras, fresh) {}

  DeviceTimeEstimator& at(std::size_t camera) override { return estimators_[camera]; }
  void stamp(std::span<const std::uint32_t> cameras, std::span<const DeviceSample> samples,
             std::span<GlobalTime> stamps) override {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      stamps[i] = estimators_[cameras[i]].Estimator::stamp(samples[i]);
    }
  }

 private:
  std::vector<Estimator> estimators_;
};

template <class Estimator>
class Banked : public DeviceTimeEstimator {
 public:
  std::unique_ptr<EstimatorBank> bank(std::size_t cameras) const final {
    return std::make_unique<BankOf<Estimator>>(static_cast<const Estimator&>(*this), cameras);
  }
};

}  // namespace simbench
