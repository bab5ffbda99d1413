#include "algorithms/device_time/rocsync_led.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/line_fit.h"
#include "laws/median.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

// A sighting as a frame that arrives at once, on the LED clock.
DeviceSample on_led_clock(const LedSample& sighting) {
  return {.sensor = sighting.sensor,
          .arrival = HostTime(sighting.led),
          .arrival_steady = SteadyTime(sighting.led),
          .exposure_us = 0};
}

// At most kConsensus of the points, evenly spaced.
std::vector<LinePoint> evenly_spaced(const std::vector<LinePoint>& points) {
  const std::size_t count = std::min(points.size(), RocsyncLedSettings::kConsensus);
  std::vector<LinePoint> chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(points[i * points.size() / count]);
  return chosen;
}

struct ConsensusLine {
  double slope = 0;
  double level = 0;
  double at(std::int64_t x) const { return level + slope * static_cast<double>(x); }
};

// Theil-Sen; at least one point.
ConsensusLine consensus(const std::vector<LinePoint>& points) {
  std::vector<double> values;
  values.reserve(points.size() * points.size() / 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i].x != points[j].x) values.push_back(slope_between(points[j], points[i]));
    }
  }
  ConsensusLine line;
  if (!values.empty()) line.slope = median_in_place(values);
  values.clear();
  for (const LinePoint& point : points) {
    values.push_back(static_cast<double>(point.y) - line.slope * static_cast<double>(point.x));
  }
  line.level = median_in_place(values);
  return line;
}

class RocsyncLed final : public DeviceTimeEstimator {
 public:
  explicit RocsyncLed(RocsyncLedSettings settings) : threshold_ns_(settings.threshold_ms * 1e6) {}

  bool offline() const override { return true; }
  bool relative() const override { return true; }
  bool shares_zero() const override { return true; }

  void on_led_sighting(const LedSample& sighting) override {
    const DeviceSample sample = on_led_clock(sighting);
    if (!anchor_) anchor_.emplace(sample);
    points_.push_back(OffsetStream::reachable(anchor_->point(sample)));
  }

  void learn(std::span<const DeviceSample> recording) override {
    if (!points_.empty()) {
      line_ = fitted();
    } else if (!recording.empty()) {
      anchor_.emplace(on_led_clock({.sensor = recording.front().sensor, .led = Nanoseconds(0)}));
    }
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    SIMBENCH_ASSERT(anchor_.has_value(), "an offline estimator learns the recording first");
    return anchor_->stamp(sample.sensor, line_.at(anchor_->x(sample.sensor)));
  }

 private:
  // At least one point.
  Line fitted() const {
    const ConsensusLine wanted = consensus(evenly_spaced(points_));
    LineSums inliers(points_.size());
    LineSums all(points_.size());
    for (const LinePoint& point : points_) {
      all.add(point);
      const double residual_ns = static_cast<double>(point.y) - wanted.at(point.x);
      if (std::abs(residual_ns) <= threshold_ns_) inliers.add(point);
    }
    const Line line = inliers.line();
    return line.count > 0 ? line : all.line();
  }

  double threshold_ns_;
  std::optional<SampleAnchor> anchor_;
  std::vector<LinePoint> points_;  // from the first sighting's
  Line line_;                      // 0 without sightings
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_rocsync_led(RocsyncLedSettings settings) {
  SIMBENCH_ASSERT(settings.threshold_ms > 0, "inliers need room");
  return std::make_unique<RocsyncLed>(settings);
}

void RocsyncLedSettings::bind(ParameterBinder& parameters) {
  parameters.number("threshold_ms", threshold_ms, 0.1, 1000,
                    "largest residual of a reading that is used",
                    "RocSync, video.py: one frame period");
}

std::vector<DeviceTimeEntry> device_time_rocsync_led() {
  return {with_settings<DeviceTimeEntry>(
      {.name = "rocsync_led",
       .family = "rocsync_led",
       .summary = "robust line through what the frames show of a clock of LEDs",
       .source = "Meyer et al. 2026; docs/reference/capture_alignment.md section 5",
       .needs = {Need::kLedClock}},
      RocsyncLedSettings{}, make_rocsync_led)};
}

}  // namespace simbench
