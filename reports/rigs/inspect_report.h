// What a recording has, on one screen: its streams with their stamps, rates and gaps, and the
// topics of a bag.
//
// JSON, schema_version 1 (what does not exist is null):
//   {"schema_version", "version", "commit",
//    "files": [{"file", "format", "closed", "lost_bytes", "lost_messages", "devices": [...],
//               "streams": [{"camera", "host", "stream", "topic", "frames", "span_s", "rate_hz",
//                            "counted", "lost_frames", "longest_gap_s", "gap_at_s", "stamps",
//                            "arrivals", "stamped_by_host"}],
//               "topics": [{"topic", "type", "publisher", "messages", "rate_hz", "bytes",
//                           "longest_gap_s"}],
//               "notes": [...]}]}
// rate_hz of a stream is by its stamps, of a topic by the log times.
#ifndef SIMBENCH_REPORTS_RIGS_INSPECT_REPORT_H_
#define SIMBENCH_REPORTS_RIGS_INSPECT_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "bags/bag_scan.h"
#include "recording/recorded_streams.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct Inspection {
  std::string file;
  std::optional<bags::BagScan> bag{};  // its streams are in `recording`
  RecordedStreams recording{};
};

Document inspect_document(const std::vector<Inspection>& files);
std::string inspect_json(const std::vector<Inspection>& files);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RIGS_INSPECT_REPORT_H_
