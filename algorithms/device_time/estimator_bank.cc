#include "algorithms/device_time/estimator_bank.h"

#include <utility>

namespace simbench {
namespace {

class MixedBank final : public EstimatorBank {
 public:
  explicit MixedBank(std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators)
      : estimators_(std::move(estimators)) {}

  DeviceTimeEstimator& at(std::size_t camera) override { return *estimators_[camera]; }
  void stamp(std::span<const std::uint32_t> cameras, std::span<const DeviceSample> samples,
             std::span<GlobalTime> stamps) override {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      stamps[i] = estimators_[cameras[i]]->stamp(samples[i]);
    }
  }

 private:
  std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators_;
};

}  // namespace

std::unique_ptr<EstimatorBank> DeviceTimeEstimator::bank(std::size_t) const { return nullptr; }

std::unique_ptr<EstimatorBank> make_bank(const EstimatorFactory& make, std::size_t cameras) {
  std::unique_ptr<DeviceTimeEstimator> fresh = make(0);
  if (auto bank = fresh->bank(cameras)) return bank;
  std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators;
  estimators.push_back(std::move(fresh));
  while (estimators.size() < cameras) estimators.push_back(make(estimators.size()));
  return std::make_unique<MixedBank>(std::move(estimators));
}

}  // namespace simbench
