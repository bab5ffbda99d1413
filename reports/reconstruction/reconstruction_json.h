// A reconstruction experiment for programs and spreadsheets.
//
// JSON, schema_version 1; what does not exist is null. A series is {"median", "p05", "p95",
// "values": [in seed order]}. Only /performance differs between equal runs.
//
//   {"schema_version", "scenario", "version", "commit", "first_seed", "seeds", "frames",
//    "rows": [{"pipeline", "host_sync", "capture_alignment" (only if something steers the
//      exposures), "device_time", "gathering", "mean_cm": series, "std_cm", "median_cm", "p95_cm",
//      "desync_ms": likewise, "sets", "failed_sets", "missing_frames": over all seeds,
//      "no_gathered_set_share", "published": null or {"mean_cm", "std_cm", "mean_inside",
//      "std_inside" (null: too few seeds to tell)}, "notes"}],
//    "published": {pipeline: {"mean_cm", "std_cm"}},
//    "published_ratio": null or {"worst", "best", "ratio": series, "published"},
//    "curve": [{"speed_m_per_s", "speed_factor", "desync_ms", "mean_cm": series, "std_cm"}],
//    "limits": [{"speed_m_per_s", "speed_factor", "floor_cm", "limit_ms", "last_ms",
//      "cost_cm_per_ms"}],
//    "speed_needed": null or {"pipeline", "desync_ms", "published_mean_cm", "speed_m_per_s",
//      "points": like curve},
//    "notes": [...], "performance": {"wall_s", "seconds_per_set"}}
//
// CSV: a line for each pipeline, medians and bands, the same names; a column capture_alignment if
// something steers the exposures of a row.
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_JSON_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_JSON_H_

#include <string>

#include "reconstruction/results.h"

namespace simbench::reports {

std::string reconstruction_json(const reconstruction::ReconstructionResults& results);
std::string reconstruction_csv(const reconstruction::ReconstructionResults& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_JSON_H_
