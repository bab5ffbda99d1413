// The sentences and cells that the table and the page of a reconstruction share.
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_TEXT_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_TEXT_H_

#include <string>
#include <vector>

#include "reconstruction/results.h"
#include "reports/reconstruction/reconstruction_limits.h"

namespace simbench::reports {

// "2.39"; "-" for NaN.
std::string cm_text(double cm);
// Median and band: "2.39 [1.80, 2.95]".
std::string cm_text(const evaluation::Series& series);
// "6.1 [5.0, 7.2]"; "0.125" needs its digits where a millisecond is much.
std::string ms_text(double ms);
std::string ms_text(const evaluation::Series& series);
// "1.20 m/s", or "x 1.5" where the script does not walk.
std::string speed_text(double speed_m_per_s, double speed_factor);
// "9.70, outside"; "-" without a published value.
std::string published_text(const std::optional<scenarios::PublishedReprojection>& published,
                           double scenarios::PublishedReprojection::*member,
                           const evaluation::Series& simulated);
// The share of seeds for which the pipeline's own gathering emitted no set.
double no_gathered_set_share(const reconstruction::ReprojectionRow& row);
std::string limit_text(const SyncLimit& limit);  // "12.5" or "> 500"
std::string cost_text(const SyncLimit& limit);   // "0.0123"

// "ntp_last_set : yoon2021_both = 3.2 [2.9, 3.9] in the mean error, seed by seed (published 4.05)."
std::string ratio_sentence(const PublishedRatio& ratio);
// Which speed of the subject the largest published mean would need.
std::string speed_sentence(const reconstruction::SpeedNeeded& needed);
// What was simulated and assumed, and what the numbers cannot tell; then what the results note.
std::vector<std::string> honest_notes(const reconstruction::ReconstructionResults& results);

inline constexpr const char* kErrorLegend =
    "error: distance between a vertex of the reconstructed mesh and the point that a depth camera "
    "measured where it sees that vertex. A value is the median over the seeds, [a, b] their band "
    "from 5 to 95 %.";
inline constexpr const char* kDesyncLegend =
    "desynchronisation: how far apart the true mid-exposures of a frame set are. For every row "
    "frames are grouped by the nearest global stamp, without a threshold; seeds without a gathered "
    "set: where the pipeline's own gathering emitted none at all.";
inline constexpr const char* kPublishedLegend =
    "published: the paper's Table 4, one recording. inside: within the band.";
inline constexpr const char* kLimitLegend =
    "desynchronisation up to: at which the median error stays within 10 % of its floor, the error "
    "at the smallest desynchronisation of the curve (interpolated). cost: the local slope of the "
    "curve there, or at its end.";

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_TEXT_H_
