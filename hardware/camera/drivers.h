// The driver of all cameras of a host, whatever they are.
//
// Cameras to which the rig file gives a recording are played (recorded_camera.h), the others are
// real ones, found by their serial number (realsense/realsense_driver.h, where librealsense2 was
// there when simbench was built).
//
// Contract
//  - open() takes the serials that the rig gives to this host, no others; list() has its recorded
//    cameras and whatever real ones are plugged in.
//  - Recordings are read when the driver is made. A real camera need not be there before open().
//
// Errors: CameraError: of the recordings; real cameras in a simbench without librealsense2.
//
//   const auto cameras = make_camera_driver(rig, me);
//   Node node(context, settings, clock, *cameras, make_host_sync, log);
#ifndef SIMBENCH_HARDWARE_CAMERA_DRIVERS_H_
#define SIMBENCH_HARDWARE_CAMERA_DRIVERS_H_

#include <memory>

#include "algorithms/ports/exchange.h"
#include "hardware/camera/camera.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

std::unique_ptr<CameraDriver> make_camera_driver(const Rig& rig, PeerId host);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CAMERA_DRIVERS_H_
