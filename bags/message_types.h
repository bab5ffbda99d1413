// Whether the messages of a type begin with a stamp that is read here: by the definition that
// stands in the bag, else by the type's name.
//
// A std_msgs/Header must be the first field (constants and comments may stand before it). Types
// that are known by name are those of ROS' own packages and of cameras' drivers; Foxglove's schemas
// have their `timestamp` first.
//
//   topic.headed = headed_by({.type = "my_msgs/Events", .encoding = Encoding::kCdr}, definition);
//
// Sources: wiki.ros.org/msg, docs.ros.org (interfaces), foxglove.dev schemas, depthai_ros_msgs,
// realsense2_camera_msgs, ffmpeg_image_transport_msgs.
#pragma once

#include <string_view>

#include "bags/bag.h"

namespace simbench::bags {

// `definition`: text as .msg files have it, of which the end may be missing; empty: none is known.
Headed headed_by(const BagTopic& topic, std::string_view definition);

// Foxglove's own schemas: protobuf or JSON, "foxglove.RawImage".
bool is_foxglove(std::string_view type);

}  // namespace simbench::bags
