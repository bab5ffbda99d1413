// Calls into librealsense2 whose errors become CameraError: rs2::error never leaves this folder.
//
//   guarded(serial, "starting the depth sensor", [&] { sensor.start(callback); });
#ifndef SIMBENCH_HARDWARE_REALSENSE_REALSENSE_ERROR_H_
#define SIMBENCH_HARDWARE_REALSENSE_REALSENSE_ERROR_H_

#include <fmt/format.h>

#include <librealsense2/rs.hpp>
#include <string>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

template <class Call>
auto guarded(const std::string& serial, const std::string& doing, Call call) {
  try {
    return call();
  } catch (const rs2::error& error) {
    throw CameraError(fmt::format("camera {}: {}: librealsense2 says: {} ({})", serial, doing,
                                  error.what(), error.get_failed_function()));
  }
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_REALSENSE_REALSENSE_ERROR_H_
