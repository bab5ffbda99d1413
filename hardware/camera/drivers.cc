#include "hardware/camera/drivers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hardware/camera/recorded_camera.h"
#ifdef SIMBENCH_HAS_REALSENSE
#include "hardware/realsense/realsense_driver.h"
#endif

namespace simbench::hardware {
namespace {

class HostCameraDriver final : public CameraDriver {
 public:
  // `real` is null where there are no real cameras.
  HostCameraDriver(const std::vector<RigCamera>& played, std::vector<std::string> real_serials,
                   std::unique_ptr<CameraDriver> real)
      : played_(played), real_serials_(std::move(real_serials)), real_(std::move(real)) {
    for (const RigCamera& camera : played) played_serials_.push_back(camera.serial);
  }

  std::vector<CameraInfo> list() override {
    std::vector<CameraInfo> result = played_.list();
    if (!real_) return result;
    for (CameraInfo& info : real_->list()) result.push_back(std::move(info));
    return result;
  }

  std::unique_ptr<Camera> open(const std::string& serial) override {
    if (has(played_serials_, serial)) return played_.open(serial);
    if (has(real_serials_, serial)) return real_->open(serial);
    std::vector<std::string> known = played_serials_;
    known.insert(known.end(), real_serials_.begin(), real_serials_.end());
    throw CameraError(
        serial, fmt::format("not of this host, whose cameras are {}",
                            known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
  }

 private:
  static bool has(const std::vector<std::string>& serials, const std::string& serial) {
    return std::find(serials.begin(), serials.end(), serial) != serials.end();
  }

  RecordedCameraDriver played_;
  std::vector<std::string> played_serials_;
  std::vector<std::string> real_serials_;
  std::unique_ptr<CameraDriver> real_;
};

#ifdef SIMBENCH_HAS_REALSENSE
std::unique_ptr<CameraDriver> real_driver(const Rig& /*rig*/, const std::string& /*serial*/) {
  return std::make_unique<RealsenseDriver>();
}
#else
std::unique_ptr<CameraDriver> real_driver(const Rig& rig, const std::string& serial) {
  throw CameraError(
      serial,
      fmt::format("this simbench was built without librealsense2; install it (docs/rigs.md: "
                  "RealSense cameras) and build again, or give the camera a \"recording\" in {}",
                  rig.file));
}
#endif

}  // namespace

std::unique_ptr<CameraDriver> make_camera_driver(const Rig& rig, PeerId host) {
  std::vector<RigCamera> played;
  std::vector<std::string> real;
  for (const RigCamera& camera : rig.hosts.at(host).cameras) {
    if (camera.recording.empty()) {
      real.push_back(camera.serial);
    } else {
      played.push_back(camera);
    }
  }
  std::unique_ptr<CameraDriver> driver;
  if (!real.empty()) driver = real_driver(rig, real.front());
  return std::make_unique<HostCameraDriver>(played, std::move(real), std::move(driver));
}

}  // namespace simbench::hardware
