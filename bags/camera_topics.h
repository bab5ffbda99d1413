// Which topics are of cameras, by type and name, and which camera's.
//
// ROS: images, compressed images, packets of video, point clouds and camera infos carry a header
// with a stamp, Foxglove's schemas of them a timestamp; realsense-ros' Metadata also the camera's
// own stamps. The topics of one stream have one base
// ("/camera/depth" of "/camera/depth/image_rect_raw"), and the one with the best stamps speaks for
// it: metadata, then the raw image, other images, camera info, points. A base that ends in the name
// of a stream (depth, color, infra1, ...) is a stream of the camera before it; else it is the
// camera. The SDK's bags have /device_0/sensor_0/Depth_0/image/data, .../metadata and
// /device_0/info. Source: docs/reference/bags.md sections 2 and 3.
//
//   const CameraTopic topic = camera_topic(bag_topic);
//   if (topic.kind == TopicKind::kImage) use(camera_of(topic.base).camera);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "bags/bag.h"

namespace simbench::bags {

enum class TopicKind : std::uint8_t {
  kOther,
  kMetadata,  // realsense-ros
  kImage,     // any, compressed ones too
  kCameraInfo,
  kPoints,
  kSdkImage,
  kSdkMetadata,
  kSdkInfo,
};

struct CameraTopic {
  TopicKind kind = TopicKind::kOther;
  std::string base{};
  int rank = 0;  // within a base: the lowest speaks for the stream
};

CameraTopic camera_topic(const BagTopic& topic);

// "camera", "depth"; a name without a camera ("/image_raw") has an empty one.
struct NamedStream {
  std::string camera;
  std::string stream;
};
NamedStream camera_of(const CameraTopic& topic);

// Whether the stamps are copies of another stream's (depth aligned to colour).
bool is_derived(std::string_view base);

}  // namespace simbench::bags
