// A bag read once: its topics, and the streams of its cameras.
//
// A stream's stamps are the camera's where the bag has them (metadata of the SDK or of
// realsense-ros: SENSOR_TIMESTAMP, else FRAME_TIMESTAMP), else those of the message header, which a
// computer may have made (RecordedStream::stamped_by_host). Arrivals: in the SDK's bags its
// TIME_OF_ARRIVAL, else BACKEND_TIMESTAMP; in those of ROS the log time, of the recorder's clock.
// StreamOrigin says which it was; one source serves a whole stream, so a stamp that a frame lacks
// makes the next best source that of all.
//
// Frames are in order of their log times, whatever the order of the file; a message that stands
// twice counts once (bags/topic_scan.h). StreamOrigin::messages count all of a topic's messages in
// the order of the file. ROS 1's header.seq counts what was published, not what a camera exposed,
// so it is no frame counter: a note says how many of its numbers are missing.
//
// A topic that looks like no camera's is read if the options name it and its messages begin with a
// header, by the definition that stands in the bag (bags/message_types.h).
//
// Messages of one topic from several publishers or with several frame ids are several cameras,
// unless one goes on where the other ended. What is left out (no stamps, copies of another stream)
// is a note.
//
//   const BagScan scan = scan_bag("rig.bag", "rig", {});
//   for (const RecordedStream& stream : scan.streams) ...
//
// Memory: 80 bytes a frame while it reads, then 32; 16 a message of other topics that are counted.
// Source: docs/reference/bags.md sections 2 and 3.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bags/bag.h"
#include "bags/topic_scan.h"
#include "recording/recorded_streams.h"

namespace simbench::bags {

// A topic with more frame ids is one camera's: drivers that count in them are known. Topics and
// frame ids of cameras beyond the second limit are left out, with a note.
inline constexpr std::size_t kMostFrameIds = 64;
inline constexpr std::size_t kMostTracks = kMostRecordedStreams;

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

// The names of topics with messages that begin with a header: what ScanOptions::topics may name. At
// most 30.
std::vector<std::string> headed_topics(const BagScan& scan);

// `name`: of the camera, if the bag has one, and of the host. Throws BagError; also for a topic of
// the options that is not there, or whose messages begin with no header.
BagScan scan_bag(const std::string& path, const std::string& name, const ScanOptions& options,
                 const ReadProgress& progress = {});

}  // namespace simbench::bags
