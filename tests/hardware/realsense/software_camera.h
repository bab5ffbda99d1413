// A RealSense camera made of software, whose frames a test injects one by one.
#pragma once

#include <cstdint>
#include <librealsense2/hpp/rs_internal.hpp>
#include <librealsense2/rs.hpp>
#include <memory>
#include <string>
#include <vector>

namespace simbench::hardware {

// One context for all tests: taking the last one down takes two seconds.
inline rs2::context& shared_context() {
  static rs2::context context;
  return context;
}

// A depth module (sync mode up to `sync_modes`, exposure in us) and a colour sensor (100 us), each
// with a few profiles.
class SoftwareCamera {
 public:
  explicit SoftwareCamera(const std::string& serial = "018322071234", float sync_modes = 260)
      : SoftwareCamera(serial, sync_modes, true) {}
  // Without any option.
  static SoftwareCamera bare() { return {"bare", 0, false}; }

  // librealsense2 names software devices up to 2.54 only, and appends what is registered twice.
  void set_name(const std::string& name) {
    if (device.supports(RS2_CAMERA_INFO_NAME)) {
      device.update_info(RS2_CAMERA_INFO_NAME, name);
    } else {
      device.register_info(RS2_CAMERA_INFO_NAME, name);
    }
  }

  // The stamps of the next frame. They stay for those after it.
  void set(rs2_frame_metadata_value value, std::int64_t number) {
    depth.set_metadata(value, number);
  }
  // The six values that frames of a well-installed camera have.
  void set_all(std::int64_t counter, std::int64_t sensor_us, std::int64_t frame_us,
               std::int64_t exposure_us = 6951) {
    set(RS2_FRAME_METADATA_FRAME_COUNTER, counter);
    set(RS2_FRAME_METADATA_SENSOR_TIMESTAMP, sensor_us);
    set(RS2_FRAME_METADATA_FRAME_TIMESTAMP, frame_us);
    set(RS2_FRAME_METADATA_ACTUAL_EXPOSURE, exposure_us);
    set(RS2_FRAME_METADATA_BACKEND_TIMESTAMP, 0);
    set(RS2_FRAME_METADATA_TIME_OF_ARRIVAL, 1);
  }
  void inject(double timestamp_ms = 0,
              rs2_timestamp_domain domain = RS2_TIMESTAMP_DOMAIN_HARDWARE_CLOCK, int number = 0) {
    depth.on_video_frame(frame(depth_profiles.front(), timestamp_ms, domain, number));
  }
  void inject_colour(int number) {
    colour.on_video_frame(
        frame(colour_profiles.front(), 0, RS2_TIMESTAMP_DOMAIN_HARDWARE_CLOCK, number));
  }

  // Before the device, which from 2.55 on makes a context of its own.
  rs2::context context = shared_context();
  rs2::software_device device;
  rs2::software_sensor depth;
  rs2::software_sensor colour;
  std::vector<rs2::stream_profile> depth_profiles;   // the first is 640x480 at 30
  std::vector<rs2::stream_profile> colour_profiles;  // likewise

 private:
  SoftwareCamera(const std::string& serial, float sync_modes, bool options)
      : depth(device.add_sensor("Stereo Module")), colour(device.add_sensor("RGB Camera")) {
    set_name("Intel RealSense D455");
    device.register_info(RS2_CAMERA_INFO_SERIAL_NUMBER, serial);
    device.register_info(RS2_CAMERA_INFO_FIRMWARE_VERSION, "5.12.3.0");
    device.register_info(RS2_CAMERA_INFO_USB_TYPE_DESCRIPTOR, "3.2");
    for (const int fps : {30, 60, 90}) add(RS2_STREAM_DEPTH, 640, 480, fps, RS2_FORMAT_Z16);
    add(RS2_STREAM_DEPTH, 848, 480, 90, RS2_FORMAT_Z16);
    add(RS2_STREAM_COLOR, 640, 480, 30, RS2_FORMAT_YUYV);
    add(RS2_STREAM_COLOR, 640, 480, 30, RS2_FORMAT_RGB8);
    if (!options) return;
    depth.add_option(RS2_OPTION_INTER_CAM_SYNC_MODE, {0, sync_modes, 0, 1});
    depth.add_option(RS2_OPTION_EXPOSURE, {1, 200'000, 33'000, 1});
    depth.add_option(RS2_OPTION_ENABLE_AUTO_EXPOSURE, {0, 1, 1, 1});
    depth.add_option(RS2_OPTION_GLOBAL_TIME_ENABLED, {0, 1, 1, 1});
    colour.add_option(RS2_OPTION_EXPOSURE, {1, 10'000, 156, 1});
    colour.add_option(RS2_OPTION_ENABLE_AUTO_EXPOSURE, {0, 1, 1, 1});
  }

  void add(rs2_stream type, int width, int height, int fps, rs2_format format) {
    const bool is_depth = type == RS2_STREAM_DEPTH;
    auto& profiles = is_depth ? depth_profiles : colour_profiles;
    const rs2_video_stream stream = {type, 0, next_id_++, width, height, fps, 2, format, {}};
    profiles.push_back((is_depth ? depth : colour).add_video_stream(stream));
  }

  rs2_software_video_frame frame(const rs2::stream_profile& profile, double timestamp_ms,
                                 rs2_timestamp_domain domain, int number) {
    return {pixels_.data(), [](void*) {}, 2, 2, timestamp_ms, domain, number, profile.get(), 0};
  }

  int next_id_ = 0;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(848 * 480 * 2);
};

// Adds the camera to the shared context. Hold the result: since 2.55 the context lists a software
// device only while somebody has the list of its arrival. Replaces the context's callback.
[[nodiscard]] inline rs2::device_list plug_in(SoftwareCamera& camera) {
  const auto arrived = std::make_shared<rs2::device_list>();
  shared_context().set_devices_changed_callback(
      [arrived](const rs2::event_information& change) { *arrived = change.get_new_devices(); });
  camera.device.add_to(shared_context());
  shared_context().set_devices_changed_callback([](const rs2::event_information&) {});
  return *arrived;
}

}  // namespace simbench::hardware
