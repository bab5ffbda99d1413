#include "hardware/realsense/realsense_camera.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <string>
#include <thread>
#include <utility>

#include "hardware/camera/stream_watch.h"
#include "hardware/realsense/realsense_frame.h"
#include "hardware/realsense/realsense_settings.h"

namespace simbench::hardware {
namespace {

constexpr auto kBetweenChecks = std::chrono::milliseconds(250);

std::string info_of(const rs2::device& device, rs2_camera_info what) {
  return device.supports(what) ? device.get_info(what) : "";
}

}  // namespace

CameraInfo realsense_info(const rs2::device& device) {
  return guarded("?", "reading what it is", [&] {
    CameraInfo info;
    info.serial = info_of(device, RS2_CAMERA_INFO_SERIAL_NUMBER);
    info.model = info_of(device, RS2_CAMERA_INFO_NAME);
    info.firmware = info_of(device, RS2_CAMERA_INFO_FIRMWARE_VERSION);
    const std::string usb = info_of(device, RS2_CAMERA_INFO_USB_TYPE_DESCRIPTOR);
    info.connection = usb.empty() ? "" : fmt::format("USB {}", usb);
    return info;
  });
}

// Passes frames from librealsense's threads to the handlers; outlives the camera if a callback is
// late.
class RealsenseCamera::Outlet {
 public:
  ~Outlet() { close(); }

  void open(const CameraSettings& settings, FrameHandler on_frame, CameraEventHandler on_event) {
    const std::lock_guard lock(mutex_);
    on_frame_ = std::move(on_frame);
    on_event_ = std::move(on_event);
    watch_ = StreamWatch(settings, settings.sync_mode == scenarios::SyncMode::kGenlock);
    watch_.start(monotonic_now());
    open_ = connected_ = true;
    checker_ = std::thread([this] { check(); });
  }

  // No handler runs after it.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      open_ = false;
    }
    changed_.notify_all();
    if (checker_.joinable()) checker_.join();
  }

  void deliver(const rs2::frame& frame, const FrameInstant& arrival, int exposure_unit_us) {
    const std::lock_guard lock(mutex_);
    if (!open_) return;
    try {
      const ReadFrame read = read_frame(frame, arrival, exposure_unit_us);
      if (!read.missing.empty()) watch_.missing_metadata(read.missing, on_event_);
      on_frame_(read.frame);
      watch_.on_frame(read.frame, on_event_);
    } catch (const rs2::error& error) {
      watch_.missing_metadata(fmt::format("readable stamps ({})", error.what()), on_event_);
    }
  }

  // Reports `event`; while no camera is connected its streams are not watched.
  void set_connected(bool connected, const CameraEvent& event) {
    const std::lock_guard lock(mutex_);
    if (!open_) return;
    connected_ = connected;
    if (connected) watch_.start(monotonic_now());
    on_event_(event);
  }

 private:
  void check() {
    std::unique_lock lock(mutex_);
    while (open_) {
      changed_.wait_for(lock, kBetweenChecks);
      if (open_ && connected_) watch_.check(monotonic_now(), on_event_);
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  bool connected_ = false;
  FrameHandler on_frame_;
  CameraEventHandler on_event_;
  StreamWatch watch_{CameraSettings{}, false};
  std::thread checker_;
};

RealsenseCamera::RealsenseCamera(const rs2::device& device)
    : info_(realsense_info(device)), outlet_(std::make_shared<Outlet>()), device_(device) {}

RealsenseCamera::~RealsenseCamera() { stop(); }

rs2::device RealsenseCamera::device() const {
  const std::lock_guard lock(mutex_);
  return device_;
}

void RealsenseCamera::configure(const CameraSettings& settings) {
  const std::lock_guard lock(mutex_);
  if (started_) throw CameraError(info_.serial, "configured while it is started");
  if (!present_) throw CameraError(info_.serial, "unplugged");
  std::vector<ChosenSensor> sensors = choose_sensors(device_, info_.serial, settings);
  apply_settings(device_, sensors, info_, settings);
  sensors_ = std::move(sensors);
  settings_ = settings;
}

void RealsenseCamera::open_sensors() {
  for (ChosenSensor& chosen : sensors_) {
    guarded(info_.serial, "starting it (does another program use it?)", [&] {
      chosen.sensor.open(chosen.profiles);
      try {
        chosen.sensor.start(
            [outlet = outlet_, unit = chosen.exposure_unit_us](const rs2::frame& frame) {
              const FrameInstant arrival = FrameInstant::now();
              outlet->deliver(frame, arrival, unit);
            });
      } catch (const rs2::error&) {
        chosen.sensor.close();
        throw;
      }
    });
    ++opened_;
  }
}

// Ignores the errors of an unplugged camera.
void RealsenseCamera::close_sensors() {
  for (; opened_ > 0; --opened_) {
    const rs2::sensor& sensor = sensors_[opened_ - 1].sensor;
    try {
      sensor.stop();
    } catch (const rs2::error&) {
    }
    try {
      sensor.close();
    } catch (const rs2::error&) {
    }
  }
}

void RealsenseCamera::start(FrameHandler on_frame, CameraEventHandler on_event) {
  const std::lock_guard lock(mutex_);
  if (!settings_) throw CameraError(info_.serial, "started before it was configured");
  if (started_) throw CameraError(info_.serial, "started twice");
  if (!present_) throw CameraError(info_.serial, "unplugged");
  outlet_->open(*settings_, std::move(on_frame), std::move(on_event));
  try {
    open_sensors();
  } catch (const CameraError&) {
    outlet_->close();
    close_sensors();
    throw;
  }
  started_ = true;
}

void RealsenseCamera::stop() {
  const std::lock_guard lock(mutex_);
  outlet_->close();
  close_sensors();
  started_ = false;
}

void RealsenseCamera::unplugged() {
  const std::lock_guard lock(mutex_);
  if (!present_) return;
  present_ = false;
  outlet_->set_connected(false, {CameraEvent::Kind::kDisconnected, "unplugged"});
  close_sensors();
}

void RealsenseCamera::plugged_in(const rs2::device& device) {
  const std::lock_guard lock(mutex_);
  if (present_) close_sensors();
  device_ = device;
  present_ = true;
  if (!settings_) return;
  try {
    sensors_ = choose_sensors(device_, info_.serial, *settings_);
    apply_settings(device_, sensors_, info_, *settings_);
    if (!started_) return;
    open_sensors();
    outlet_->set_connected(true, {CameraEvent::Kind::kReturned, "plugged in again, and streaming"});
  } catch (const CameraError& error) {
    close_sensors();
    outlet_->set_connected(
        false, {CameraEvent::Kind::kNote, fmt::format("plugged in again, but: {}", error.what())});
  }
}

}  // namespace simbench::hardware
