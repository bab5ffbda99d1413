#include "algorithms/device_time/yoon2021.h"

#include <algorithm>
#include <optional>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/line_fit.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

class OnlineRegression final : public Banked<OnlineRegression> {
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
class ExpandingRegression final : public Banked<ExpandingRegression> {
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

class OfflineRegression final : public Banked<OfflineRegression> {
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

namespace {

constexpr double kLargestCorrectionNs = 1e17;

GlobalTime corrected(HostTime arrival, double correction_ns) {
  const double limited = std::clamp(correction_ns, -kLargestCorrectionNs, kLargestCorrectionNs);
  return GlobalTime(
      Nanoseconds(saturate(Int128{nanoseconds_of(arrival)} + saturate_round(limited))));
}

class Equation1 final : public Banked<Equation1> {
 public:
  Equation1(Equation1Reading reading, std::size_t intervals)
      : reading_(reading), window_(intervals) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    if (!previous_) {
      previous_ = sample;
      return GlobalTime(sample.arrival.time_since_epoch());
    }
    const DeviceSample previous = *previous_;
    previous_ = sample;
    const Int128 dx_us = Int128{sample.sensor.time_since_epoch().count()} -
                         previous.sensor.time_since_epoch().count();
    const Int128 dy_ns = Int128{nanoseconds_of(sample.arrival)} - nanoseconds_of(previous.arrival);
    // The fit is of dy - dx over dx: the same line, less its slope of one.
    const std::int64_t x = saturate(dx_us);
    window_.push({.x = x, .y = saturate(dy_ns - 1000 * dx_us)});
    const Line line = window_.line();
    const double dx_ns = 1000 * static_cast<double>(x);
    switch (reading_) {
      case Equation1Reading::kPrinted:
        return corrected(sample.arrival, printed_correction_ns(line, dx_ns));
      case Equation1Reading::kIntervalPrevious:
        return corrected(previous.arrival, dx_ns + line.at(x));
      case Equation1Reading::kIntervalCurrent:
        break;
    }
    return corrected(sample.arrival, dx_ns + line.at(x));
  }

 private:
  // The product of two times plus a bare number: its value depends on the unit, which is the
  // milliseconds of the SDK's stamps.
  static double printed_correction_ns(const Line& line, double dx_ns) {
    const double intercept_ms = line.at(0) * 1e-6;
    const double slope = 1 + line.slope * 1e-3;  // ns per us, so per 1000
    return (intercept_ms * (dx_ns * 1e-6) + slope) * 1e6;
  }

  Equation1Reading reading_;
  LineWindow window_;
  std::optional<DeviceSample> previous_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_equation1(Equation1Reading reading,
                                                    std::size_t intervals) {
  return std::make_unique<Equation1>(reading, intervals);
}

namespace {

class RawArrival final : public Banked<RawArrival> {
 public:
  GlobalTime stamp(const DeviceSample& sample) override {
    return GlobalTime(sample.arrival.time_since_epoch());
  }
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_raw_arrival() { return std::make_unique<RawArrival>(); }

namespace {

class SensorNormalised final : public Banked<SensorNormalised> {
 public:
  bool relative() const override { return true; }

  GlobalTime stamp(const DeviceSample& sample) override {
    const std::int64_t sensor_us = sample.sensor.time_since_epoch().count();
    if (!first_us_) first_us_ = sensor_us;
    return GlobalTime(Nanoseconds(saturate(1000 * (Int128{sensor_us} - *first_us_))));
  }

 private:
  std::optional<std::int64_t> first_us_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_sensor_normalised() {
  return std::make_unique<SensorNormalised>();
}

namespace {

constexpr const char* kEquation1Source =
    "Yoon et al. 2021, eq. (1); docs/reference/paper.md section 3";

AlgorithmInfo info(const char* name, const char* family, const char* summary, const char* source) {
  return {.name = name, .family = family, .summary = summary, .source = source};
}

DeviceTimeEntry equation1(const char* name, Equation1Reading reading, const char* summary) {
  return {.info = info(name, "eq1", summary, kEquation1Source),
          .make = [reading](const Parameters&) { return make_equation1(reading); }};
}

DeviceTimeEntry regression(const char* name, std::size_t frames, const char* summary) {
  return {.info = info(name, "regression", summary, kEquation1Source),
          .make = [frames](const Parameters&) { return make_regression({frames}); }};
}

}  // namespace

std::vector<DeviceTimeEntry> device_time_yoon2021() {
  return {
      regression("regression_30", 30,
                 "regression of arrival on sensor stamp over the last 30 frames (R3, default)"),
      {.info = info("regression_offline", "regression",
                    "regression of arrival on sensor stamp over the whole recording (R3)",
                    kEquation1Source),
       .make = [](const Parameters&) { return make_offline_regression(); }},
      equation1("eq1_printed", Equation1Reading::kPrinted,
                "eq. (1) as printed, coefficients swapped (R0): nonsense, kept to show it"),
      equation1("eq1_interval_previous", Equation1Reading::kIntervalPrevious,
                "regression of intervals, added to the previous arrival (R1)"),
      equation1("eq1_interval_current", Equation1Reading::kIntervalCurrent,
                "regression of intervals, added to the current arrival (R2): a period late"),
      {.info = info("raw_arrival", "raw_arrival", "the arrival itself (R4)", kEquation1Source),
       .make = [](const Parameters&) { return make_raw_arrival(); }},
      {.info = info("sensor_normalised", "sensor_normalised",
                    "sensor stamp minus the camera's first: GenLock captures only",
                    "Yoon et al. 2021, GenLock; docs/reference/paper.md section 5"),
       .make = [](const Parameters&) { return make_sensor_normalised(); }},
      {.info = info("oracle", "oracle",
                    "the camera's own host's clock at the true mid-exposure: simulation only",
                    "the truth"),
       .make = nullptr},
      regression("regression_300", 300,
                 "regression of arrival on sensor stamp over the last 300 frames (R3)"),
      {.info = info("regression_all", "regression",
                    "regression of arrival on sensor stamp over all frames so far (R3)",
                    kEquation1Source),
       .make = [](const Parameters&) { return make_expanding_regression(); }},
  };
}

}  // namespace simbench
