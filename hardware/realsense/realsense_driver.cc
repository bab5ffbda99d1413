#include "hardware/realsense/realsense_driver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "hardware/realsense/realsense_camera.h"
#include "hardware/realsense/realsense_settings.h"

namespace simbench::hardware {
namespace {

// The opened cameras that still exist.
class OpenCameras {
 public:
  void add(RealsenseCamera& camera) {
    const std::lock_guard lock(mutex_);
    cameras_.push_back(&camera);
  }
  void remove(RealsenseCamera& camera) {
    const std::lock_guard lock(mutex_);
    std::erase(cameras_, &camera);
  }

  void on_change(const rs2::event_information& change) {
    const std::lock_guard lock(mutex_);
    for (RealsenseCamera* camera : cameras_) {
      if (change.was_removed(camera->device())) camera->unplugged();
    }
    for (const rs2::device& device : change.get_new_devices()) {
      const std::string serial = realsense_info(device).serial;
      for (RealsenseCamera* camera : cameras_) {
        if (camera->info().serial == serial) camera->plugged_in(device);
      }
    }
  }

 private:
  std::mutex mutex_;
  std::vector<RealsenseCamera*> cameras_;
};

class OpenCamera final : public RealsenseCamera {
 public:
  OpenCamera(const rs2::device& device, std::shared_ptr<OpenCameras> open)
      : RealsenseCamera(device), open_(std::move(open)) {
    open_->add(*this);
  }
  ~OpenCamera() override { open_->remove(*this); }
  OpenCamera(const OpenCamera&) = delete;
  OpenCamera& operator=(const OpenCamera&) = delete;

 private:
  std::shared_ptr<OpenCameras> open_;
};

}  // namespace

class RealsenseDriver::State {
 public:
  explicit State(const rs2::context& shared) : context(shared) {
    context.set_devices_changed_callback([cameras = open](const rs2::event_information& change) {
      // librealsense2's thread. A device that vanishes while it is read is ignored: its removal is
      // reported next.
      try {
        cameras->on_change(change);
      } catch (const rs2::error&) {
      } catch (const CameraError&) {
      }
    });
  }

  rs2::context context;
  std::shared_ptr<OpenCameras> open = std::make_shared<OpenCameras>();
};

RealsenseDriver::RealsenseDriver() {
  try {
    state_ = std::make_shared<State>(rs2::context());
  } catch (const rs2::error& error) {
    throw CameraError(fmt::format("librealsense2 does not start: {}", error.what()));
  }
}

RealsenseDriver::RealsenseDriver(const rs2::context& context)
    : state_(std::make_shared<State>(context)) {}

RealsenseDriver::~RealsenseDriver() = default;

std::vector<CameraInfo> RealsenseDriver::list() {
  std::vector<CameraInfo> result;
  try {
    for (const rs2::device& device : state_->context.query_devices()) {
      result.push_back(realsense_info(device));
    }
  } catch (const rs2::error& error) {
    throw CameraError(
        fmt::format("cameras cannot be listed: librealsense2 says: {}", error.what()));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const CameraInfo& a, const CameraInfo& b) { return a.serial < b.serial; });
  return result;
}

std::unique_ptr<Camera> RealsenseDriver::open(const std::string& serial) {
  return guarded(serial, "opening it", [&]() -> std::unique_ptr<Camera> {
    std::vector<std::string> found;
    for (const rs2::device& device : state_->context.query_devices()) {
      const CameraInfo info = realsense_info(device);
      if (info.serial == serial) return std::make_unique<OpenCamera>(device, state_->open);
      found.push_back(info.serial);
    }
    std::sort(found.begin(), found.end());
    throw CameraError(serial,
                      fmt::format("not plugged in; RealSense cameras found: {}",
                                  found.empty() ? "none (are librealsense's udev rules installed?)"
                                                : fmt::format("{}", fmt::join(found, ", "))));
  });
}

}  // namespace simbench::hardware
