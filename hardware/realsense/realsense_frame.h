// The stamps of an rs2::frame as a CameraFrame.
//
//  - sensor, frame: metadata SENSOR_TIMESTAMP and FRAME_TIMESTAMP, modulo 2^32 us as the camera's
//    register counts. Without FRAME_TIMESTAMP the frame's own time stamp stands for it (in the
//    domain HARDWARE_CLOCK the same value; in SYSTEM_TIME the host's clock in us modulo 2^32), and
//    without SENSOR_TIMESTAMP the frame stamp: later by the way from mid-exposure to readout.
//  - counter: FRAME_COUNTER, else the number that librealsense gave the frame.
//  - exposure: ACTUAL_EXPOSURE in the unit of the sensor, else 0.
//  - backend: BACKEND_TIMESTAMP, which is whole milliseconds of the host's wall clock (against its
//    documentation), converted to the monotonic clock by the wall clock's reading at arrival.
//    0 (of the RSUSB backend) and values not within two seconds before the arrival are discarded.
//
// Errors: rs2::error, for the caller to catch. Source: docs/reference/d455.md section 1.
#pragma once

#include <librealsense2/rs.hpp>
#include <string_view>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

struct FrameInstant {
  MonotonicTime monotonic{};
  double wall_ms = 0;  // the same instant, since 1970

  static FrameInstant now();
};

struct ReadFrame {
  CameraFrame frame;
  std::string_view missing;  // the first metadata value that it lacks; empty: none
};

ReadFrame read_frame(const rs2::frame& frame, const FrameInstant& arrival, int exposure_unit_us);

}  // namespace simbench::hardware
