#include "algorithms/device_time/hull.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "algorithms/device_time/offset_stream.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/lower_hull.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

using Sample = OffsetStream::Sample;

// Slopes are in ns per us.
double slope_of_ppm(double ppm) { return ppm * 1e-3; }

// Adds a point to a hull of the newest ones; returns the hull's vertices.
std::span<const LinePoint> extended(WindowHull& hull, LinePoint point) {
  if (hull.full()) hull.pop();
  hull.push(point);
  return hull.hull();
}
std::span<const LinePoint> extended(SwitchingHull& hull, LinePoint point) {
  hull.add(point);
  return hull.current();
}

template <class Hull>
class OnlineHullEstimator final : public DeviceTimeEstimator {
 public:
  OnlineHullEstimator(Hull hull, double max_skew_ppm)
      : max_slope_(slope_of_ppm(max_skew_ppm)), hull_(std::move(hull)) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    const Sample kind = stream_.push(sample);
    if (kind == Sample::kFirst) hull_.clear();
    if (kind != Sample::kLate) line_ = middle_line(extended(hull_, stream_.point()), max_slope_);
    return stream_.stamp(line_.at(stream_.point().x));
  }

 private:
  double max_slope_;
  OffsetStream stream_;
  Hull hull_;
  SupportLine line_;
};

// A recording in which a clock was set or restarted counts as several, each with its own line.
class OfflineHullEstimator final : public DeviceTimeEstimator {
 public:
  explicit OfflineHullEstimator(double max_skew_ppm) : max_slope_(slope_of_ppm(max_skew_ppm)) {}

  bool offline() const override { return true; }

  void learn(std::span<const DeviceSample> recording) override {
    OffsetStream stream;
    LowerHull hull;
    Int128 sum_x = 0;
    std::int64_t points = 0;
    const auto close = [&] {
      if (points == 0) return;
      const std::int64_t twice_mean_x = saturate(2 * sum_x / points);
      lines_.push_back(support_line(hull.vertices(), twice_mean_x, max_slope_));
      hull.clear();
      sum_x = 0;
      points = 0;
    };
    for (const DeviceSample& sample : recording) {
      const Sample kind = stream.push(sample);
      if (kind == Sample::kLate) continue;
      if (kind == Sample::kFirst) close();
      hull.add(stream.point());
      sum_x += stream.point().x;
      ++points;
    }
    close();
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    SIMBENCH_ASSERT(!lines_.empty(), "an offline estimator learns the recording first");
    if (stream_.push(sample) == Sample::kFirst && next_line_ < lines_.size()) ++next_line_;
    return stream_.stamp(lines_[next_line_ - 1].at(stream_.point().x));
  }

 private:
  double max_slope_;
  std::vector<SupportLine> lines_;
  OffsetStream stream_;
  std::size_t next_line_ = 0;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_window_hull(WindowHullSettings settings) {
  return std::make_unique<OnlineHullEstimator<WindowHull>>(WindowHull(settings.frames),
                                                           settings.max_skew_ppm);
}

std::unique_ptr<DeviceTimeEstimator> make_switching_hull(SwitchingHullSettings settings) {
  SIMBENCH_ASSERT(settings.period_s > 0, "a hull grows for some time");
  return std::make_unique<OnlineHullEstimator<SwitchingHull>>(
      SwitchingHull(saturate_round(settings.period_s * 1e6)), settings.max_skew_ppm);
}

std::unique_ptr<DeviceTimeEstimator> make_offline_hull(OfflineHullSettings settings) {
  return std::make_unique<OfflineHullEstimator>(settings.max_skew_ppm);
}

void bind_max_skew(ParameterBinder& parameters, double& max_skew_ppm) {
  parameters.number("max_skew_ppm", max_skew_ppm, 1, 100'000,
                    "limit of a line's slope: twice the fastest slew of NTP", "RFC 5905");
}

void WindowHullSettings::bind(ParameterBinder& parameters) {
  bind_max_skew(parameters, max_skew_ppm);
}
void SwitchingHullSettings::bind(ParameterBinder& parameters) {
  bind_max_skew(parameters, max_skew_ppm);
}
void OfflineHullSettings::bind(ParameterBinder& parameters) {
  bind_max_skew(parameters, max_skew_ppm);
}

std::vector<DeviceTimeEntry> device_time_hull() {
  const auto info = [](const char* name, const char* summary, const char* source) {
    return AlgorithmInfo{.name = name, .family = "hull", .summary = summary, .source = source};
  };
  const char* const hull = "docs/reference/device_time.md section 1";
  const char* const tic_sync =
      "Harrison, Newman: TICSync, 2011; docs/reference/device_time.md section 1";
  return {
      with_settings<DeviceTimeEntry>(info("hull_300", "lower hull of the last 300 frames", hull),
                                     WindowHullSettings{.frames = 300}, make_window_hull),
      with_settings<DeviceTimeEntry>(
          info("hull_switch_10s", "two growing lower hulls, 10 s apart: 10 to 20 s of frames",
               tic_sync),
          SwitchingHullSettings{.period_s = 10}, make_switching_hull),
      with_settings<DeviceTimeEntry>(
          info("hull_switch_60s", "two growing lower hulls, 60 s apart: 1 to 2 min of frames",
               tic_sync),
          SwitchingHullSettings{.period_s = 60}, make_switching_hull),
      with_settings<DeviceTimeEntry>(
          info("hull_offline", "lower hull of the whole recording", hull), OfflineHullSettings{},
          make_offline_hull),
  };
}

}  // namespace simbench
