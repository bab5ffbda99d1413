// A reconstruction experiment for people: the paper's Table 4 over seeds, and how good the
// synchronisation must be for a subject of some speed.
//
// It begins with the answer. A row for each pipeline with mean and
// standard deviation of the reprojection error beside the published ones; details of the sets; the
// curve of error over desynchronisation; the largest tolerable desynchronisation for each speed;
// the assumptions. No line of a table is wider than 100 columns with pipeline names of up to 21.
// Medians are over seeds. Between the points of the curve values are interpolated linearly.
//
//   std::cout << plain(reconstruction_document(results));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruction/results.h"
#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"

namespace simbench::reports {

// The tolerable excess of the error over its floor.
inline constexpr double kToleratedGrowth = 0.10;

// The limit for one speed of the subject. The floor is the error at the smallest desynchronisation
// of the curve: calibration and depth noise, no effect of time.
struct SyncLimit {
  double speed_m_per_s = 0;
  double speed_factor = 1;
  double floor_cm = reconstruction::kNoError;
  // The largest desynchronisation at which the error stays within kToleratedGrowth of the floor;
  // nothing: beyond last_ms.
  std::optional<double> limit_ms;
  double last_ms = 0;
  // The slope of the curve at the limit, or at its end.
  double cost_cm_per_ms = reconstruction::kNoError;
};

// Returns a limit for each speed, in the curve's order. Points without a value are left out.
std::vector<SyncLimit> sync_limits(const std::vector<reconstruction::CurvePoint>& curve);

// The mean error of the row with the largest published mean, divided by that of the row with the
// smallest, seed by seed (NaN where one of them has none).
struct PublishedRatio {
  std::string worst;
  std::string best;
  evaluation::Series ratio;
  double published = 0;
};

// Returns nothing unless two rows have a published value.
std::optional<PublishedRatio> published_ratio(
    const std::vector<reconstruction::ReprojectionRow>& rows);

// Returns the factor on the script's speeds at which the median mean error over `points` first
// reaches `mean_cm`.
std::optional<double> speed_factor_for(const std::vector<reconstruction::CurvePoint>& points,
                                       double mean_cm);

// Which pipeline gives the smallest reprojection error, whether that is above what a perfect
// synchronisation leaves, how far apart cameras may be, and what is uncertain.
AnswerText reconstruction_answer(const reconstruction::ReconstructionResults& results);

// Its first block is Table 4.
Document reconstruction_document(const reconstruction::ReconstructionResults& results);

// Its cells and sentences.
//
// "2.39"; "-" for NaN.
std::string cm_text(double cm);
// Median and band: "2.39 [1.80, 2.95]".
std::string cm_text(const evaluation::Series& series);
// "6.1", with more digits below a millisecond: "0.125". With a band: "6.1 [5.0, 7.2]".
std::string desync_text(double ms);
std::string desync_text(const evaluation::Series& series);
// "1.20 m/s", or "x 1.5" for a script without walking.
std::string speed_text(double speed_m_per_s, double speed_factor);
// The sum of a count over the row's seeds.
std::int64_t total_over_seeds(const reconstruction::ReprojectionRow& row,
                              std::int64_t reconstruction::SeedReprojection::*member);
// The share of seeds for which the pipeline's own gathering emitted no set.
double no_gathered_set_share(const reconstruction::ReprojectionRow& row);
std::string limit_text(const SyncLimit& limit);  // "12.5" or "> 500"

// The speed of the subject that the largest published mean would need.
std::string speed_sentence(const reconstruction::SpeedNeeded& needed);
// The simulated subject, the assumptions and the limits of the numbers, then the results' notes.
std::vector<std::string> honest_notes(const reconstruction::ReconstructionResults& results);

// The experiment as a figure (reports/figures/figure.h).
//
// One panel: the median mean error over desynchronisation, a curve for each speed of the subject,
// and the published means as lines. A second one, if computed: the error over the speed, at the
// desynchronisation of the row with the largest published mean. Without either, Figure::absent.
Figure reconstruction_figure(const reconstruction::ReconstructionResults& results);

// The experiment for programs and spreadsheets.
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
std::string reconstruction_json(const reconstruction::ReconstructionResults& results);
std::string reconstruction_csv(const reconstruction::ReconstructionResults& results);

}  // namespace simbench::reports
