// A series of time errors: what the clock shows minus what it should show, with its steps, its
// frequency offset and its size.
//
// The points are one interval apart; where some are missing a new piece begins. All functions are
// over all pieces, and none gives a NaN.
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const std::optional<double> offset = remove_frequency_offset(series);
//   const TimeErrorSummary size = time_error_of(series);
//   const std::vector<TimeErrorStep> steps = steps_of(series);
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace simbench::evaluation {

// Points without a gap between them, the first at `start_s` on any zero.
struct TimeErrorPiece {
  double start_s = 0;
  std::vector<double> x_s{};
};

struct TimeErrorSeries {
  double interval_s = 1;
  std::vector<TimeErrorPiece> pieces{};
};

// What is assumed of a series here: a positive finite interval, times and errors within this either
// way. Otherwise: a programming error.
inline constexpr double kLargestSeconds = 1e12;

// Checks that.
void check_series(const TimeErrorSeries& series);

std::int64_t points_in(const TimeErrorSeries& series);

// A jump of the time error between two neighbouring points that stays.
//
// Each difference of neighbours is compared with the median of the two on either side of it; it
// jumps if it is farther from that than kStepFactor times the scatter of these distances. The
// scatter is 1.4826 times the median absolute distance over the series (the standard deviation, for
// normal noise), where that is 0 (a constant, coarse steps of a counter) the mean absolute one. A
// jump that the next difference takes back by more than half is counted together with that: what
// then remains may be a step, and a single outlier leaves nothing. Noise, drift and outliers
// are thus no steps. The first and the last difference of a piece are none, since nothing shows
// whether they stay, and a series with fewer than kFewestDifferences has none.
struct TimeErrorStep {
  double at_s = 0;    // the first point behind it
  double step_s = 0;  // less what the neighbours' drift explains
};
inline constexpr double kStepFactor = 10;
inline constexpr std::int64_t kFewestDifferences = 5;

// In order of time within each piece. O(N).
std::vector<TimeErrorStep> steps_of(const TimeErrorSeries& series);

// Subtracts the least-squares slope over all points, about their mean time, so that the mean error
// stays. Returns the slope, the frequency offset of the clock without a unit (1e-9: one ppb);
// nothing, and nothing is changed, with fewer than two points.
std::optional<double> remove_frequency_offset(TimeErrorSeries& series);

// Time error over all points. Constant: the mean. Dynamic: what is left without the mean, not
// filtered: the dynamic error of Recommendation ITU-T G.8273.2 is this one behind a low-pass
// (dTE_L) or a high-pass (dTE_H) of 0.1 Hz. The kinds of time error: Recommendation ITU-T G.8260.
struct TimeErrorSummary {
  double max_te_ms = 0;  // the largest magnitude
  double rms_te_ms = 0;
  double constant_te_ms = 0;
  double dynamic_te_ms = 0;      // RMS
  double dynamic_te_p2p_ms = 0;  // largest minus smallest
  // The magnitudes that so many percent of the points do not exceed: by linear
  // interpolation between neighbours in order of size (quantile() of evaluation/statistics).
  double p50_te_ms = 0;
  double p95_te_ms = 0;
  double p99_te_ms = 0;
  double p99_9_te_ms = 0;
};
// O(N log N). Memory: a copy of the points.
TimeErrorSummary time_error_of(const TimeErrorSeries& series);

// The share of all points whose magnitude is at most that, from 0 to 1; nothing without a point.
std::optional<double> share_within(const TimeErrorSeries& series, double limit_s);

}  // namespace simbench::evaluation
