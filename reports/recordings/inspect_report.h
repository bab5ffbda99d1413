// What a recording has, on one screen: its streams with their stamps, rates and gaps, the account
// of their frames, the clocks of their cameras, and the topics of a bag; on request the stamps of
// device_time algorithms.
//
// JSON, schema_version 1 (what does not exist is null):
//   {"schema_version", "version", "commit",
//    "files": [{"file", "format", "closed", "lost_bytes", "lost_messages", "devices": [...],
//               "streams": [{"camera", "host", "stream", "topic", "frames", "span_s", "rate_hz",
//                            "counted", "lost_frames", "never_exposed_frames",
//                            "unknown_frames", "longest_gap_s", "gap_at_s", "stamps", "arrivals",
//                            "stamped_by_host", "clocks": {"long_intervals",
//                            "sensor_period_ms": {"mean", "sd"}, "arrival_period_ms": {"mean",
//                            "sd"}, "drift_ppm", "envelope_drift_ppm", "residual_ms": {"sd", "p95",
//                            "p99", "max"}, "excess_ms": {"mean", "p50", "p95", "p99", "max"}}}],
//               "stamps": [{"camera", "stream", "device_time", "jitter_ms", "residual_ms": {...},
//                           "drift_ppm"}],
//               "topics": [{"topic", "type", "publisher", "messages", "rate_hz", "bytes",
//                           "longest_gap_s"}],
//               "notes": [...]}]}
// rate_hz of a stream is by its stamps, of a topic by the log times. Definitions of clocks and
// stamps: evaluation/frames/camera_statistics.h; of the account of frames:
// evaluation/frames/frame_account.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bags/bag_scan.h"
#include "evaluation/frames/gathered_sets.h"
#include "recording/recorded_streams.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct Inspection {
  std::string file;
  std::optional<bags::BagScan> bag{};  // its streams are in `recording`
  RecordedStreams recording{};
  std::vector<evaluation::StampedStream> stamps{};  // of its streams
  bool is_folder = false;                           // of recordings: a rig by itself
};

// Ends with the next command, which takes the files as they were read: `reading` are the words of
// the options for that.
Document inspect_document(const std::vector<Inspection>& files,
                          const std::vector<std::string>& reading = {});
std::string inspect_json(const std::vector<Inspection>& files);

}  // namespace simbench::reports
