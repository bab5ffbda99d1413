// What the numbers of a reconstruction say to somebody who has to synchronise cameras: how good the
// synchronisation must be for a subject of some speed, and how the published rows compare.
//
// Medians are over seeds. Between the points of the curve values are interpolated linearly.
//
//   for (const SyncLimit& limit : sync_limits(results.curve)) ...
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_LIMITS_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_LIMITS_H_

#include <optional>
#include <string>
#include <vector>

#include "reconstruction/results.h"

namespace simbench::reports {

// By how much the error may exceed its floor.
inline constexpr double kToleratedGrowth = 0.10;

// For one speed of the subject. The floor is the error at the smallest desynchronisation of the
// curve: calibration and depth noise, no time.
struct SyncLimit {
  double speed_m_per_s = 0;
  double speed_factor = 1;
  double floor_cm = reconstruction::kNoError;
  // The largest desynchronisation at which the error stays within kToleratedGrowth of the floor;
  // nothing: it does up to last_ms.
  std::optional<double> limit_ms;
  double last_ms = 0;
  // The slope of the curve there, or at its end if it is not reached.
  double cost_cm_per_ms = reconstruction::kNoError;
};

// One for each speed, in the curve's order. Points without a value are left out.
std::vector<SyncLimit> sync_limits(const std::vector<reconstruction::CurvePoint>& curve);

// The mean error of the row with the largest published mean, divided by that of the row with the
// smallest, seed by seed (NaN where one of them has none).
struct PublishedRatio {
  std::string worst;
  std::string best;
  evaluation::Series ratio;
  double published = 0;
};

// Nothing unless two rows have a published value.
std::optional<PublishedRatio> published_ratio(
    const std::vector<reconstruction::ReprojectionRow>& rows);

// Where the median mean error over `points` first reaches `mean_cm`, as a factor on the script's
// speeds.
std::optional<double> speed_factor_for(const std::vector<reconstruction::CurvePoint>& points,
                                       double mean_cm);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_LIMITS_H_
