// Cameras that play a recording in real time: the vendor-free source of a rig.
//
// For trying a rig, its network and its algorithms without a camera, and for the real-network
// experiment, where the true times of what is played are known. Which recordings can be played and
// when a frame of one is due after its zero: recorded_frames.h.
//
// Schedule. A camera plays from an instant T0, its recording's zero:
//  - without a trigger file, 20 ms after start();
//  - with one, the instant that the file holds: nanoseconds of CLOCK_MONOTONIC, as decimal text.
//    It is looked for every 4 ms. A file that was there before start() counts too, unless its
//    instant is more than 1 s before start(). When it is removed playing ends, and begins anew with
//    the next file: `"trigger": {"on_command", "off_command"}` of a rig can write and remove it.
// Frames that were due before start() are not played, as no camera was on. A recording is played
// once; its end is told (kEnded).
//
// Frames carry the recorded counter, exposure and device stamps; `arrived` is the instant at which
// the frame was due, to the nanosecond, and `backend` as long before it as it was in the recording.
// It is handed over as soon after that as this machine's timers allow: how late they are is no
// property of any camera. Of the settings only the streams are
// used: those that are wanted are played, one that the recording has not is refused.
//
// One thread plays all cameras of a driver, asleep but for the deliveries; it is there from the
// first start() on. A frame costs no allocation. Handlers must not call start() or stop() of a
// camera of the same driver. Cameras may outlive their driver.
//
// Errors: CameraError: those of recorded_frames.h from the constructor; from open() a serial that
// is none of these; from configure() a stream that is not in the recording; from start() one that
// is started.
//
//   const std::vector<RigCamera> cameras = {{.serial = "left", .recording = "monday#ntp/1"}};
//   RecordedCameraDriver driver(cameras);
//   auto camera = driver.open("left");
#ifndef SIMBENCH_HARDWARE_CAMERA_RECORDED_CAMERA_H_
#define SIMBENCH_HARDWARE_CAMERA_RECORDED_CAMERA_H_

#include <memory>
#include <string>
#include <vector>

#include "hardware/camera/camera.h"
#include "hardware/camera/recorded_frames.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

class RecordedPlayer;

class RecordedCameraDriver final : public CameraDriver {
 public:
  // Reads the recordings. Paths are as the program sees them.
  explicit RecordedCameraDriver(const std::vector<RigCamera>& cameras);

  std::vector<CameraInfo> list() override;
  std::unique_ptr<Camera> open(const std::string& serial) override;

 private:
  struct Entry {
    CameraInfo info;
    std::string trigger_file;
    std::shared_ptr<const PlayedCamera> played;
  };

  std::vector<Entry> entries_;
  std::shared_ptr<RecordedPlayer> player_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CAMERA_RECORDED_CAMERA_H_
