#include "hardware/realsense/realsense_frame.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace simbench::hardware {
namespace {

constexpr double kLongestLeadMs = 2000;

std::optional<std::int64_t> metadata(const rs2::frame& frame, rs2_frame_metadata_value value) {
  if (!frame.supports_frame_metadata(value)) return std::nullopt;
  return static_cast<std::int64_t>(frame.get_frame_metadata(value));
}

DeviceStamp stamp(std::int64_t us) { return {static_cast<std::uint32_t>(us)}; }

StampDomain domain_of(rs2_timestamp_domain domain) {
  switch (domain) {
    case RS2_TIMESTAMP_DOMAIN_HARDWARE_CLOCK:
      return StampDomain::kHardwareClock;
    case RS2_TIMESTAMP_DOMAIN_GLOBAL_TIME:
      return StampDomain::kGlobalTime;
    default:
      return StampDomain::kSystemTime;
  }
}

std::optional<MonotonicTime> backend_of(const rs2::frame& frame, const FrameInstant& arrival) {
  const auto backend_ms = metadata(frame, RS2_FRAME_METADATA_BACKEND_TIMESTAMP);
  if (!backend_ms || *backend_ms == 0) return std::nullopt;
  const double lead_ms = arrival.wall_ms - static_cast<double>(*backend_ms);
  if (!(lead_ms >= 0 && lead_ms <= kLongestLeadMs)) return std::nullopt;
  return arrival.monotonic - from_ms(lead_ms);
}

}  // namespace

FrameInstant FrameInstant::now() {
  const MonotonicTime monotonic = monotonic_now();
  const auto wall = std::chrono::system_clock::now().time_since_epoch();
  return {monotonic, to_ms(std::chrono::duration_cast<Nanoseconds>(wall))};
}

ReadFrame read_frame(const rs2::frame& frame, const FrameInstant& arrival, int exposure_unit_us) {
  ReadFrame result;
  CameraFrame& read = result.frame;
  read.arrived = arrival.monotonic;
  read.stream = frame.get_profile().stream_type() == RS2_STREAM_COLOR ? StreamKind::kColour
                                                                      : StreamKind::kDepth;
  read.domain = domain_of(frame.get_frame_timestamp_domain());
  const auto counter = metadata(frame, RS2_FRAME_METADATA_FRAME_COUNTER);
  read.counter = static_cast<std::uint32_t>(
      counter.value_or(static_cast<std::int64_t>(frame.get_frame_number())));
  const auto exposure = metadata(frame, RS2_FRAME_METADATA_ACTUAL_EXPOSURE);
  read.exposure_us = static_cast<std::uint32_t>(exposure.value_or(0) * exposure_unit_us);
  const auto readout = metadata(frame, RS2_FRAME_METADATA_FRAME_TIMESTAMP);
  read.frame = stamp(readout ? *readout : std::llround(frame.get_timestamp() * 1e3));
  const auto sensor = metadata(frame, RS2_FRAME_METADATA_SENSOR_TIMESTAMP);
  read.sensor = sensor ? stamp(*sensor) : read.frame;
  read.backend = backend_of(frame, arrival);
  if (!readout) result.missing = "FRAME_TIMESTAMP";
  if (!sensor) result.missing = "SENSOR_TIMESTAMP";
  return result;
}

}  // namespace simbench::hardware
