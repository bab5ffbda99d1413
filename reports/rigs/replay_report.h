// The results of `simbench replay` as text, JSON and CSV.
//
// JSON, schema_version 1 (what does not exist is null):
//   {"schema_version", "version", "commit", "files", "notes",
//    "cameras": [{"camera", "host", "stream", "frames", "missing_frames", "long_intervals",
//                 "span_s", "sensor_period_ms": {"mean", "sd"}, "arrival_period_ms": {"mean",
//                 "sd"}, "drift_ppm", "envelope_drift_ppm", "residual_ms": {"sd", "p95", "p99",
//                 "max"}, "excess_ms": {"mean", "p50", "p95", "p99", "max"}}],
//    "rows": [{"camera", "stream", "device_time", "needs_polls", "jitter_ms", "residual_ms": {...},
//              "drift_ppm"}],
//    "rigs": [{"stream", "cameras", "period_ms", "complete_pulses", "first_arrival_range_ms",
//              "common_start_plausible", "verified": false,
//              "rows": [{"device_time", "needs_polls", "amd_ms", "rmdv_ms",
//                        "gathering": [{"gathering", "sets", "discarded_frames", "amd_ms",
//                                       "rmdv_ms"}]}]}],
//    "warnings"}
// Definitions: evaluation/replay/replay.h.
#ifndef SIMBENCH_REPORTS_RIGS_REPLAY_REPORT_H_
#define SIMBENCH_REPORTS_RIGS_REPLAY_REPORT_H_

#include <ostream>
#include <string>
#include <vector>

#include "evaluation/replay/replay.h"

namespace simbench::reports {

std::string replay_table(const evaluation::Replay& replay);
std::string replay_json(const evaluation::Replay& replay, const std::vector<std::string>& files);

// One line per camera and estimator: camera,stream,device_time,jitter_ms,residual_sd_ms,...
std::string replay_csv(const evaluation::Replay& replay);

// frames.csv: camera,frame,sensor_ms,arrival_ms and a column global_ms_NAME for every estimator,
// milliseconds with six decimals; empty where it needs polls. Cameras of several streams are named
// "camera/stream".
void write_replay_frames(const evaluation::Replay& replay, std::ostream& out);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RIGS_REPLAY_REPORT_H_
