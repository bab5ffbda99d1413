#include "bags/camera_topics.h"

#include <algorithm>
#include <array>
#include <vector>

namespace simbench::bags {
namespace {

constexpr std::array<std::string_view, 12> kStreamNames = {
    "depth",  "color", "colour", "rgb",     "infra",    "infra1",
    "infra2", "ir",    "ir2",    "fisheye", "fisheye1", "fisheye2"};
constexpr std::array<std::string_view, 10> kImageTypes = {
    "sensor_msgs/Image",
    "sensor_msgs/CompressedImage",
    "ffmpeg_image_transport_msgs/FFMPEGPacket",
    "depthai_ros_msgs/FFMPEGPacket",
    "foxglove.CompressedImage",
    "foxglove.CompressedVideo",
    "foxglove.RawImage",
    "foxglove_msgs/CompressedImage",
    "foxglove_msgs/CompressedVideo",
    "foxglove_msgs/RawImage"};
// What image transports append.
constexpr std::array<std::string_view, 5> kTransports = {"compressed", "compressedDepth", "theora",
                                                         "ffmpeg", "zstd"};

template <std::size_t size>
bool is_one_of(const std::array<std::string_view, size>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('/'), name.size());
    if (end > 0) parts.push_back(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return parts;
}

std::string joined(const std::vector<std::string_view>& parts, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text.append("/").append(parts[i]);
  return text;
}

bool is_of_sdk(std::string_view name) {
  return name.starts_with("/device_") &&
         (name.ends_with("/info") || name.find("/sensor_") != name.npos);
}

CameraTopic sdk_topic(std::string_view name) {
  const std::vector<std::string_view> parts = parts_of(name);
  if (parts.size() == 2 && parts[1] == "info") {
    return {TopicKind::kSdkInfo, joined(parts, 1)};
  }
  if (parts.size() != 5 || parts[3] != "image" || !parts[1].starts_with("sensor_")) return {};
  const std::string base = joined(parts, 3);
  if (parts[4] == "data") return {TopicKind::kSdkImage, base};
  if (parts[4] == "metadata") return {TopicKind::kSdkMetadata, base};
  return {};
}

TopicKind kind_of(std::string_view type) {
  if (is_one_of(kImageTypes, type)) return TopicKind::kImage;
  if (type == "sensor_msgs/CameraInfo" || type == "foxglove.CameraCalibration") {
    return TopicKind::kCameraInfo;
  }
  if (type == "sensor_msgs/PointCloud2" || type == "foxglove.PointCloud") {
    return TopicKind::kPoints;
  }
  if (type == "realsense2_camera_msgs/Metadata" || type == "realsense2_camera/Metadata") {
    return TopicKind::kMetadata;
  }
  return TopicKind::kOther;
}

int rank_of(TopicKind kind, std::string_view last, bool transported) {
  if (kind == TopicKind::kMetadata) return 0;
  if (kind == TopicKind::kCameraInfo) return 5;
  if (kind == TopicKind::kPoints) return 6;
  if (transported) return 4;
  if (last == "image_raw") return 1;
  return last == "image_rect_raw" ? 2 : 3;
}

}  // namespace

CameraTopic camera_topic(const BagTopic& topic) {
  if (is_of_sdk(topic.name)) return sdk_topic(topic.name);
  const TopicKind kind = kind_of(topic.type);
  if (kind == TopicKind::kOther || topic.headed == Headed::kNo) return {};
  std::vector<std::string_view> parts = parts_of(topic.name);
  const bool transported = parts.size() > 1 && is_one_of(kTransports, parts.back());
  if (transported) parts.pop_back();
  if (parts.empty()) return {};
  return {kind, joined(parts, parts.size() - 1), rank_of(kind, parts.back(), transported)};
}

NamedStream camera_of(const CameraTopic& topic) {
  std::vector<std::string_view> parts = parts_of(topic.base);
  NamedStream named{.camera = {}, .stream = topic.kind == TopicKind::kPoints ? "points" : "image"};
  if (topic.kind == TopicKind::kSdkImage) {
    named.stream = std::string(parts.back());
    std::replace(named.stream.begin(), named.stream.end(), '_', ' ');
    named.camera = std::string(parts.front());
    return named;
  }
  if (!parts.empty() && (is_one_of(kStreamNames, parts.back()) || is_derived(topic.base))) {
    named.stream = std::string(parts.back());
    parts.pop_back();
  }
  // realsense-ros: a name space and a node of one name, "/camera/camera".
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  const std::string camera = joined(parts, parts.size());
  named.camera = camera.empty() ? camera : camera.substr(1);
  return named;
}

bool is_derived(std::string_view base) {
  return base.find("/aligned_depth_to_") != std::string_view::npos;
}

}  // namespace simbench::bags
