// A camera's samples as exact points (sensor stamp, offset), and as a clean series of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "algorithms/device_time/device_time.h"
#include "laws/line_fit.h"
#include "laws/saturate.h"

namespace simbench {

// Counts samples from a first one: estimators fit the offset arrival - sensor over the sensor
// stamp, in small exact integers, so that hours and dates cost no precision.
//
//   SampleAnchor anchor(first);
//   LinePoint p = anchor.point(sample);              // us, ns
//   GlobalTime t = anchor.stamp(sample.sensor, offset_ns);
class SampleAnchor {
 public:
  explicit SampleAnchor(const DeviceSample& first)
      : sensor_us_(first.sensor.time_since_epoch().count()),
        arrival_ns_(nanoseconds_of(first.arrival)) {}

  // x: sensor stamp in us; y: offset of arrival to sensor in ns; both from the first sample's.
  LinePoint point(const DeviceSample& sample) const {
    const std::int64_t arrival_ns = nanoseconds_of(sample.arrival);
    if (Elapsed elapsed; in_64_bits(sample.sensor, elapsed)) {
      LinePoint point = {.x = elapsed.us, .y = 0};
      if (!__builtin_sub_overflow(arrival_ns, arrival_ns_, &point.y) &&
          !__builtin_sub_overflow(point.y, elapsed.ns, &point.y)) {
        return point;
      }
    }
    return far_point(sample);
  }

  std::int64_t x(DeviceTime sensor) const {
    if (Elapsed elapsed; in_64_bits(sensor, elapsed)) return elapsed.us;
    return saturate(elapsed_us(sensor));
  }

  // The host's reading at sensor stamp `sensor` when the offset is `offset_ns`.
  GlobalTime stamp(DeviceTime sensor, double offset_ns) const {
    const std::int64_t offset = saturate_round(offset_ns);
    if (Elapsed elapsed; in_64_bits(sensor, elapsed)) {
      std::int64_t stamp_ns = 0;
      if (!__builtin_add_overflow(arrival_ns_, elapsed.ns, &stamp_ns) &&
          !__builtin_add_overflow(stamp_ns, offset, &stamp_ns)) {
        return GlobalTime(Nanoseconds(stamp_ns));
      }
    }
    return far_stamp(sensor, offset);
  }

 private:
  struct Elapsed {
    std::int64_t us = 0;
    std::int64_t ns = 0;
  };

  // Nearly always; the far ones, in 128 bits, are for stamps from anywhere.
  bool in_64_bits(DeviceTime sensor, Elapsed& elapsed) const {
    return !__builtin_sub_overflow(sensor.time_since_epoch().count(), sensor_us_, &elapsed.us) &&
           !__builtin_mul_overflow(elapsed.us, std::int64_t{1000}, &elapsed.ns);
  }

  [[gnu::cold, gnu::noinline]] LinePoint far_point(const DeviceSample& sample) const {
    const Int128 x = elapsed_us(sample.sensor);
    return {saturate(x), saturate(Int128{nanoseconds_of(sample.arrival)} - arrival_ns_ - 1000 * x)};
  }
  [[gnu::cold, gnu::noinline]] GlobalTime far_stamp(DeviceTime sensor, std::int64_t offset) const {
    return GlobalTime(Nanoseconds(saturate(arrival_ns_ + 1000 * elapsed_us(sensor) + offset)));
  }

  Int128 elapsed_us(DeviceTime sensor) const {
    return Int128{sensor.time_since_epoch().count()} - sensor_us_;
  }

  std::int64_t sensor_us_;
  std::int64_t arrival_ns_;
};

// A clean series for the estimators that assume one: strictly increasing sensor stamps and two
// clocks that are nearly alike.
//
// Each sample is one of
//   kFirst  the first, or the first after a clock was set or restarted: discard all before it
//   kNext   later than all before: use it for the estimate
//   kLate   not later than the newest (reordered, or equal): stamp it, do not use it
//
// A series begins anew if the sensor stamp lies more than 1 s before the newest (the camera was
// restarted), or if the offset differs from the newest by more than 1 s + 0.1 % of the sensor time
// in between (a clock was set). Smaller steps go to the estimator, which has its own memory. A gap
// alone, however long, begins no series: a drift of up to 1000 ppm stays within the bound.
//
//   OffsetStream stream;
//   switch (stream.push(sample)) {...}
//   return stream.stamp(offset_ns);
class OffsetStream {
 public:
  enum class Sample : std::uint8_t { kFirst, kNext, kLate };

  // |x| and |y| of a point stay within this, so that products of differences fit 128 bits.
  static constexpr std::int64_t kReach = std::int64_t{1} << 61;

  Sample push(const DeviceSample& sample) {
    sensor_ = sample.sensor;
    if (anchor_) point_ = reachable(anchor_->point(sample));
    if (!anchor_ || !continues(point_)) {
      anchor_.emplace(sample);
      newest_ = point_ = {};
      return Sample::kFirst;
    }
    if (point_.x <= newest_.x) return Sample::kLate;
    newest_ = point_;
    return Sample::kNext;
  }

  bool empty() const { return !anchor_.has_value(); }

  // The sample pushed last: x the sensor stamp in us, y the offset in ns, from kFirst's.
  LinePoint point() const { return point_; }

  // The global stamp of the sample pushed last if its offset is `offset_ns`.
  GlobalTime stamp(double offset_ns) const { return anchor_->stamp(sensor_, offset_ns); }

  // For samples that are not pushed, such as the frames where polls are. Not if empty().
  const SampleAnchor& anchor() const { return *anchor_; }

  // Whether a point may belong to the same two clocks, see above. Not if empty().
  bool continues(LinePoint point) const {
    const std::int64_t dx_us = point.x - newest_.x;
    const std::int64_t dy_ns = point.y - newest_.y;
    return dx_us >= -kLatestUs && std::abs(dy_ns) <= kLargestStepNs + std::abs(dx_us);
  }

  static LinePoint reachable(LinePoint point) {
    return {std::clamp(point.x, -kReach, kReach), std::clamp(point.y, -kReach, kReach)};
  }

 private:
  static constexpr std::int64_t kLatestUs = 1'000'000;
  static constexpr std::int64_t kLargestStepNs = 1'000'000'000;

  std::optional<SampleAnchor> anchor_;
  DeviceTime sensor_{};
  LinePoint point_;
  LinePoint newest_;
};

}  // namespace simbench
