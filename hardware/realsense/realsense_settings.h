// A capture's settings as profiles and options of a RealSense device.
//
//  - Profiles: kind, size and mode rate of the scenario; depth as Z16, colour as YUYV if the device
//    has that.
//  - Inter Cam Sync Mode: default 0, master 1, slave 2, full_slave 3, genlock 4. A trigger faster
//    than half the mode rate (2 % more is allowed, as scenarios are) is refused in genlock.
//  - Exposure: microseconds for the depth module, 100 us for a colour sensor of its own, as UVC
//    counts; auto exposure on or off.
//  - Global time is switched off: the stamps wanted are the camera's own.
//
// Errors: CameraError: what was requested, what the device has and, if known, which firmware has
// more. Source: docs/reference/d455.md sections 2 and 3; units of colour exposure by users'
// reports.
//
//   auto sensors = choose_sensors(device, serial, settings);
//   apply_settings(device, sensors, info, settings);
//   guarded(serial, "starting the depth sensor", [&] { sensor.start(callback); });
#pragma once

#include <fmt/format.h>

#include <librealsense2/rs.hpp>
#include <string>
#include <vector>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

struct ChosenSensor {
  rs2::sensor sensor;
  std::vector<rs2::stream_profile> profiles;
  int exposure_unit_us = 1;
};

// The sensors to stream from, each with its profiles.
std::vector<ChosenSensor> choose_sensors(const rs2::device& device, const std::string& serial,
                                         const CameraSettings& settings);

void apply_settings(const rs2::device& device, const std::vector<ChosenSensor>& sensors,
                    const CameraInfo& info, const CameraSettings& settings);

// Calls librealsense2. Its errors become CameraError: rs2::error never leaves this folder.
template <class Call>
auto guarded(const std::string& serial, const std::string& doing, Call call) {
  try {
    return call();
  } catch (const rs2::error& error) {
    throw CameraError(serial, fmt::format("{}: librealsense2 says: {} ({})", doing, error.what(),
                                          error.get_failed_function()));
  }
}

}  // namespace simbench::hardware
