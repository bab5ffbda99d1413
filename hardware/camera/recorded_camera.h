// Cameras that play a recording in real time: the vendor-free source of a rig.
//
// They serve to try a rig, its network and its algorithms without a camera, and the real-network
// experiment, where the true times of the played frames are known. recorded_frames.h says which
// recordings can be played and when each frame is due after the recording's zero.
//
// Schedule. A camera plays from an instant T0, its recording's zero:
//  - without a trigger file, 20 ms after start();
//  - with one, the instant that the file holds: nanoseconds of CLOCK_MONOTONIC, as decimal text.
//    The file is polled every 4 ms. A file from before start() counts too, unless its instant is
//    more than 1 s before start(). When the file is removed playing ends; it begins anew with the
//    next file: `"trigger": {"on_command", "off_command"}` of a rig can write and remove it.
// Frames that were due before start() are not played. A recording is played once; a kEnded event
// reports its end, and a kNote with each start() what the reader left out of a CSV.
//
// Frames carry the recorded counter, exposure and device stamps. `arrived` is the instant at which
// the frame was due, to the nanosecond, and `backend` as long before it as in the recording. The
// frame is handed over as soon after that as this machine's timers allow: their lateness is not in
// the stamps. Only the streams and the steering of the settings are used: the wanted streams are
// played, and one that the recording lacks is refused.
//
// Steering. Where the settings say how, frames follow the controls of CameraSteering: all of a
// frame's stamps and its due time move alike (played_steering.h), and an inserted frame has the
// exposure that it would have. The recording should be of cameras that ran free. Controls reach the
// camera at once, none is lost and none is noisy; start_at() is refused where the recording does
// not say when exposures begin, that is, without truth.
//
// One thread plays all cameras of a driver; it starts with the first start() and sleeps between
// deliveries. A frame costs no allocation. Handlers must not call start(), stop() or controls of a
// camera of the same driver. Cameras may outlive their driver.
//
// Errors: CameraError: those of recorded_frames.h from the constructor; an unknown serial from
// open(); a stream that is not in the recording from configure(); a second start().
//
//   const std::vector<RigCamera> cameras = {{.serial = "left", .recording = "monday#ntp/1"}};
//   RecordedCameraDriver driver(cameras);
//   auto camera = driver.open("left");
#pragma once

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
