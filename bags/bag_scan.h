// A bag read once: its topics, and the streams of its cameras.
//
// A stream's stamps are the camera's where the bag has them (metadata of the SDK or of
// realsense-ros: SENSOR_TIMESTAMP, else FRAME_TIMESTAMP), else those of the message header, which a
// computer may have made (RecordedStream::stamped_by_host). Arrivals: in the SDK's bags its
// TIME_OF_ARRIVAL, else BACKEND_TIMESTAMP; in those of ROS the log time, of the recorder's clock.
// StreamOrigin says which it was; one source serves a whole stream, so a stamp that a frame lacks
// makes the next best source that of all.
//
// Messages of one topic from several publishers or with several frame ids are several cameras,
// unless one goes on where the other ended. What is left out (no stamps, copies of another stream)
// is a note.
//
//   const BagScan scan = scan_bag("rig.bag", "rig", {});
//   for (const RecordedStream& stream : scan.streams) ...
//
// Memory: 80 bytes a frame while it reads, then 32. Source: docs/reference/bags.md
// sections 2 and 3.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "recording/recorded_streams.h"

namespace simbench::bags {

struct TopicScan {
  BagTopic topic{};
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  // By log time, in order of the file.
  Nanoseconds first{};
  Nanoseconds last{};
  Nanoseconds longest_gap{};
  Nanoseconds gap_at{};  // its begin
  bool is_camera = false;

  // Mean, by the log times; 0 with fewer than two messages.
  double rate_hz() const;
  // The same topic in the file that follows, where it has messages.
  void append(const TopicScan& next);
};

struct BagScan {
  BagFacts facts;
  std::vector<TopicScan> topics;  // in order of occurrence
  std::vector<RecordedStream> streams;
  std::vector<std::string> notes;    // for the user: damage, what was left out
  std::vector<std::string> devices;  // "Intel RealSense D455, serial number 0123"
};

struct ScanOptions {
  // The streams of these topics alone, whatever stands beside them; empty: of all that look like a
  // camera's.
  std::vector<std::string> topics{};
  bool all_topics = false;  // also counts the messages of topics that have no stamps
};

// `name`: of the camera, if the bag has one, and of the host. Throws BagError; also for a topic of
// the options that is not there or has no stamp.
BagScan scan_bag(const std::string& path, const std::string& name, const ScanOptions& options,
                 const ReadProgress& progress = {});

}  // namespace simbench::bags
