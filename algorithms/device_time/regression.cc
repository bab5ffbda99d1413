#include "algorithms/device_time/regression.h"

#include <optional>

#include "algorithms/device_time/line_fit.h"
#include "algorithms/device_time/saturate.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// The first sample: stamps count from it, so that the numbers to fit are small.
class Base {
 public:
  explicit Base(const DeviceSample& first)
      : sensor_us_(first.sensor.time_since_epoch().count()),
        arrival_ns_(nanoseconds_of(first.arrival)) {}

  // x: sensor stamp in us; y: offset of arrival to sensor in ns.
  LinePoint point(const DeviceSample& sample) const {
    const Int128 x = elapsed_us(sample);
    const Int128 y = Int128{nanoseconds_of(sample.arrival)} - arrival_ns_ - 1000 * x;
    return {saturate(x), saturate(y)};
  }

  // The host's reading when the offset is that of the line.
  GlobalTime on_line(const DeviceSample& sample, const Line& line) const {
    const Int128 x = elapsed_us(sample);
    const std::int64_t offset_ns = saturate_round(line.at(saturate(x)));
    return GlobalTime(Nanoseconds(saturate(arrival_ns_ + 1000 * x + offset_ns)));
  }

 private:
  Int128 elapsed_us(const DeviceSample& sample) const {
    return Int128{sample.sensor.time_since_epoch().count()} - sensor_us_;
  }

  std::int64_t sensor_us_;
  std::int64_t arrival_ns_;
};

class OnlineRegression final : public DeviceTimeEstimator {
 public:
  explicit OnlineRegression(RegressionWindow window) : window_(window.frames) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    if (!base_) base_.emplace(sample);
    window_.push(base_->point(sample));
    return base_->on_line(sample, window_.line());
  }

 private:
  std::optional<Base> base_;
  LineWindow window_;
};

class OfflineRegression final : public DeviceTimeEstimator {
 public:
  bool offline() const override { return true; }

  void learn(std::span<const DeviceSample> recording) override {
    if (recording.empty()) return;
    base_.emplace(recording.front());
    LineSums sums(recording.size());
    for (const DeviceSample& sample : recording) sums.add(base_->point(sample));
    line_ = sums.line();
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    SIMBENCH_ASSERT(base_.has_value(), "an offline estimator learns the recording first");
    return base_->on_line(sample, line_);
  }

 private:
  std::optional<Base> base_;
  Line line_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_regression(RegressionWindow window) {
  return std::make_unique<OnlineRegression>(window);
}

std::unique_ptr<DeviceTimeEstimator> make_offline_regression() {
  return std::make_unique<OfflineRegression>();
}

}  // namespace simbench
