#include "algorithms/device_time/regression.h"

#include <optional>

#include "algorithms/device_time/line_fit.h"
#include "algorithms/device_time/sample_anchor.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

class OnlineRegression final : public DeviceTimeEstimator {
 public:
  explicit OnlineRegression(RegressionWindow window) : window_(window.frames) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    if (!anchor_) anchor_.emplace(sample);
    const LinePoint point = anchor_->point(sample);
    window_.push(point);
    return anchor_->stamp(sample.sensor, window_.line().at(point.x));
  }

 private:
  std::optional<SampleAnchor> anchor_;
  LineWindow window_;
};

// Least squares over all points so far, from means and sums of squared deviations (Welford), which
// lose nothing however many points there are.
class ExpandingRegression final : public DeviceTimeEstimator {
 public:
  GlobalTime stamp(const DeviceSample& sample) override {
    if (!anchor_) anchor_.emplace(sample);
    const LinePoint point = anchor_->point(sample);
    const auto x = static_cast<double>(point.x);
    const auto y = static_cast<double>(point.y);
    ++count_;
    const double from_old_mean_x = x - mean_x_;
    mean_x_ += from_old_mean_x / count_;
    mean_y_ += (y - mean_y_) / count_;
    spread_ += from_old_mean_x * (x - mean_x_);
    common_ += from_old_mean_x * (y - mean_y_);
    const double slope = spread_ > 0 ? common_ / spread_ : 0;
    return anchor_->stamp(sample.sensor, mean_y_ + slope * (x - mean_x_));
  }

 private:
  std::optional<SampleAnchor> anchor_;
  double count_ = 0;
  double mean_x_ = 0;
  double mean_y_ = 0;
  double spread_ = 0;
  double common_ = 0;
};

class OfflineRegression final : public DeviceTimeEstimator {
 public:
  bool offline() const override { return true; }

  void learn(std::span<const DeviceSample> recording) override {
    if (recording.empty()) return;
    anchor_.emplace(recording.front());
    LineSums sums(recording.size());
    for (const DeviceSample& sample : recording) sums.add(anchor_->point(sample));
    line_ = sums.line();
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    SIMBENCH_ASSERT(anchor_.has_value(), "an offline estimator learns the recording first");
    return anchor_->stamp(sample.sensor, line_.at(anchor_->x(sample.sensor)));
  }

 private:
  std::optional<SampleAnchor> anchor_;
  Line line_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_regression(RegressionWindow window) {
  return std::make_unique<OnlineRegression>(window);
}

std::unique_ptr<DeviceTimeEstimator> make_expanding_regression() {
  return std::make_unique<ExpandingRegression>();
}

std::unique_ptr<DeviceTimeEstimator> make_offline_regression() {
  return std::make_unique<OfflineRegression>();
}

}  // namespace simbench
