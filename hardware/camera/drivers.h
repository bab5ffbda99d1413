// The driver of all cameras of a host, real and recorded.
//
// Cameras with a recording in the rig file are played (recorded_camera.h). The others are real
// cameras, found by their serial number (realsense/realsense_driver.h, if simbench was built with
// librealsense2).
//
// Contract
//  - open() takes only the serials of this host in the rig; list() returns its recorded cameras and
//    all real cameras that are plugged in.
//  - Recordings are read by make_camera_driver(). A real camera need not be there before open().
//
// Errors: CameraError for an unusable recording, and for a real camera without librealsense2.
//
//   const auto cameras = make_camera_driver(rig, me);
//   Node node(context, settings, clock, *cameras, make_pipeline, log);
#pragma once

#include <memory>

#include "algorithms/ports/exchange.h"
#include "hardware/camera/camera.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

std::unique_ptr<CameraDriver> make_camera_driver(const Rig& rig, PeerId host);

}  // namespace simbench::hardware
