// The findings of `simbench stability` as text, CSV and JSON; the JSON of stability also for other
// results.
//
// JSON, schema_version 1 (what does not exist is left out of a list, or null):
//   {"schema_version", "version", "commit", "answer" (reports/text/answer_json.h),
//    "files": [{"file", "format", "series", "first_s", "interval_s", "samples", "points",
//               "left_out", "gaps", "longest_gap_s", "frequency_offset_ppb", "summaries",
//               "start": {"points", "until_s", "largest_ms", "left_out", "settled_max_te_ms",
//                         "settled_rms_te_ms"},
//               "max_te_ms", "rms_te_ms", "constant_te_ms", "dynamic_te_ms", "dynamic_te_p2p_ms",
//               "p50_te_ms", "p95_te_ms", "p99_te_ms", "p99_9_te_ms",
//               "adev", "mdev", "hdev", "tdev_ms":
//                 [{"tau_s", "value", "terms", "low", "high", "noise", "reliable"}],
//               "mtie_ms": [{"tau_s", "value", "terms"}],
//               "steps": [{"at_s", "step_ms"}], "verdicts" (reports/stability/verdict_text.h),
//               "notes": [...]}]}
// frequency_offset_ppb is null unless it was removed; at_s counts from the first point, which is
// first_s on the log's own scale; samples are all points, points those of the grid; for summaries
// only max_te_ms and rms_te_ms exist. low and high are the 95 % confidence interval under the
// power-law noise "noise" ("white_pm", "flicker_pm", "white_fm", "flicker_fm", "random_walk_fm");
// these are null, and the value is not reliable, where that cannot be told. Definitions:
// evaluation/stability/stability.h, time_error.h and log_stability.h.
//
// CSV: file,format,quantity,tau_s,value,terms,low,high,noise,reliable, a line for each value;
// quantities are the members of the JSON that are numbers, without tau_s and terms, and its lists;
// reliable is 1 or 0.
#pragma once

#include <string>
#include <vector>

#include "evaluation/stability/log_stability.h"
#include "evaluation/stability/mask_verdict.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// The series of a file, of which one may be named.
//
// JSON, schema_version 1: {"schema_version", "version", "commit",
//   "files": [{"file", "series": [{"name", "format", "points", "first_s", "last_s"}]}]}
struct LogSeriesOfFile {
  std::string file{};
  std::vector<evaluation::ClockLogSeries> series{};
};
Document log_series_document(const std::vector<LogSeriesOfFile>& files);
std::string log_series_json(const std::vector<LogSeriesOfFile>& files);

// A measured clock, and what masks say of it.
struct StabilityFinding {
  evaluation::LogStability log{};
  std::vector<evaluation::MaskVerdict> verdicts{};
};

// "tracking.log"; of a file that has several series with the name of the one.
std::string log_name(const evaluation::LogStability& log);

// The verdicts, the largest time error of the files, its parts, and what breaks them.
AnswerText stability_answer(const std::vector<StabilityFinding>& findings);
// The answer, a section for all files, and one for each.
Document stability_document(const std::vector<StabilityFinding>& findings);
std::string stability_csv(const std::vector<StabilityFinding>& findings);
std::string stability_json(const std::vector<StabilityFinding>& findings);

// A list of the points of a curve, without their certainty.
Json points_json(const std::vector<evaluation::StabilityPoint>& points);
// The members "max_te_ms" to "mtie_ms" above.
void add_stability(Json& object, const evaluation::Stability& stability);
// A line for each tau. A deviation that is not reliable has a "?" behind it; ADEV and TDEV have
// their interval beside them.
Table stability_table(const evaluation::Stability& stability);

}  // namespace simbench::reports
