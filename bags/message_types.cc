#include "bags/message_types.h"

#include <algorithm>
#include <array>

namespace simbench::bags {
namespace {

constexpr std::array<std::string_view, 46> kHeaded = {
    "sensor_msgs/Image",
    "sensor_msgs/CompressedImage",
    "sensor_msgs/CameraInfo",
    "sensor_msgs/PointCloud",
    "sensor_msgs/PointCloud2",
    "sensor_msgs/Imu",
    "sensor_msgs/LaserScan",
    "sensor_msgs/MultiEchoLaserScan",
    "sensor_msgs/Range",
    "sensor_msgs/MagneticField",
    "sensor_msgs/FluidPressure",
    "sensor_msgs/Illuminance",
    "sensor_msgs/Temperature",
    "sensor_msgs/RelativeHumidity",
    "sensor_msgs/NavSatFix",
    "sensor_msgs/JointState",
    "sensor_msgs/MultiDOFJointState",
    "sensor_msgs/Joy",
    "sensor_msgs/BatteryState",
    "sensor_msgs/TimeReference",
    "stereo_msgs/DisparityImage",
    "nav_msgs/Odometry",
    "nav_msgs/Path",
    "nav_msgs/OccupancyGrid",
    "diagnostic_msgs/DiagnosticArray",
    "vision_msgs/Detection2D",
    "vision_msgs/Detection2DArray",
    "vision_msgs/Detection3D",
    "vision_msgs/Detection3DArray",
    "visualization_msgs/Marker",
    "realsense2_camera/Metadata",
    "realsense2_camera/IMUInfo",
    "realsense2_camera/Extrinsics",
    "realsense2_camera_msgs/Metadata",
    "realsense2_camera_msgs/IMUInfo",
    "realsense2_camera_msgs/Extrinsics",
    "realsense2_camera_msgs/RGBD",
    "ffmpeg_image_transport_msgs/FFMPEGPacket",
    "depthai_ros_msgs/FFMPEGPacket",
    "depthai_ros_msgs/HandLandmarkArray",
    "depthai_ros_msgs/ImuWithMagneticField",
    "depthai_ros_msgs/SpatialDetectionArray",
    "depthai_ros_msgs/TrackDetection2DArray",
    "depthai_ros_msgs/TrackedFeatures",
    "theora_image_transport/Packet",
    "point_cloud_interfaces/CompressedPointCloud2",
};

// Messages of these have the stamp of a header without its number, as CDR has it anyway.
constexpr std::array<std::string_view, 3> kFoxgloveOfRos = {
    "foxglove_msgs/CompressedImage", "foxglove_msgs/CompressedVideo", "foxglove_msgs/RawImage"};

template <std::size_t size>
bool has_name(const std::array<std::string_view, size>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool is_known(const BagTopic& topic) {
  const std::string_view type = topic.type;
  if (has_name(kHeaded, type)) return true;
  if (type.starts_with("geometry_msgs/") && type.ends_with("Stamped")) return true;
  return topic.encoding == Encoding::kCdr && has_name(kFoxgloveOfRos, topic.type);
}

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

// The type of the first field; empty: there is none.
std::string_view first_field(std::string_view definition) {
  while (!definition.empty()) {
    const std::size_t end = std::min(definition.find('\n'), definition.size());
    std::string_view line = definition.substr(0, end);
    definition.remove_prefix(std::min(end + 1, definition.size()));
    line = line.substr(0, line.find('#'));
    // Definitions of other types follow.
    if (line.starts_with("====")) break;
    const bool is_constant = line.find('=') != std::string_view::npos;
    const std::string_view type = next_word(line);
    if (!type.empty() && !is_constant) return type;
  }
  return {};
}

}  // namespace

bool is_foxglove(std::string_view type) { return type.starts_with("foxglove."); }

Headed headed_by(const BagTopic& topic, std::string_view definition) {
  if (topic.encoding == Encoding::kProtobuf || topic.encoding == Encoding::kJson) {
    return is_foxglove(topic.type) ? Headed::kYes : Headed::kNo;
  }
  if (topic.encoding == Encoding::kOther || is_foxglove(topic.type)) return Headed::kNo;
  if (is_known(topic)) return Headed::kYes;
  if (definition.empty()) return Headed::kUnknown;
  const std::string_view first = first_field(definition);
  const bool is_header = first == "Header" || first == "std_msgs/Header" ||
                         first == "std_msgs/msg/Header" || first == "roslib/Header";
  return is_header ? Headed::kYes : Headed::kNo;
}

}  // namespace simbench::bags
