// The frames of one topic (and frame id) as a bag has them, before one source of stamps is chosen
// for all. Stamps are in the unit of their names; kNoStamp where the bag has none. Source:
// docs/reference/bags.md sections 2 and 3.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bags/camera_topics.h"
#include "recording/recorded_streams.h"

namespace simbench::bags {

inline constexpr std::int64_t kNoStamp = std::numeric_limits<std::int64_t>::min();
inline constexpr std::uint64_t kNoMessage = std::numeric_limits<std::uint64_t>::max();

struct RawFrame {
  std::uint64_t message = kNoMessage;  // of its topic
  std::int64_t log_ns = 0;
  std::int64_t header_ns = kNoStamp;
  std::int64_t counter = kNoStamp;
  std::int64_t sensor_us = kNoStamp;  // SENSOR_TIMESTAMP
  std::int64_t frame_us = kNoStamp;   // FRAME_TIMESTAMP
  std::int64_t arrival_ms = kNoStamp;
  std::int64_t backend_ms = kNoStamp;
  std::int64_t exposure_us = kNoStamp;
  std::int64_t bytes = kNoStamp;

  // A value of the frame's metadata, by the name that the SDK or realsense-ros gives it; unknown
  // names are ignored.
  void set(std::string_view name, std::int64_t value);
  // Takes what metadata of the same frame says.
  void take_metadata(const RawFrame& part);
};

struct FrameTrack {
  std::uint32_t topic = 0;
  CameraTopic camera{};
  std::string topic_name{};
  std::string frame_id{};
  std::string domain{};  // of the header's stamps, where the bag says it; as it says it
  std::vector<RawFrame> frames{};
};

// The whole number that a text begins with: metadata has "4285000630" and "12.000000". Nothing if
// it is none.
std::optional<std::int64_t> whole_number(std::string_view text);

// Appends frames of `track` to the notes and to the stream; false, with a note, if there is no
// stamp that can be used. `place`: the file, for the notes.
bool make_stream(const FrameTrack& track, const std::string& place, RecordedStream& stream,
                 std::vector<std::string>& notes);

}  // namespace simbench::bags
