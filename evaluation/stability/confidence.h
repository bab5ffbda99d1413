// How certain a deviation is: its chi-squared confidence interval.
//
// A variance that is a mean of squares of correlated normal terms is distributed nearly as
// chi-squared over its degrees of freedom. With edf of them the true deviation lies, in 95 % of all
// series, between deviation sqrt(edf / q(0.975)) and deviation sqrt(edf / q(0.025)), where q are
// quantiles of chi-squared with edf degrees. That is for one power-law noise
// (evaluation/stability/noise_type.h) alone; steps, drift and periodic errors are none.
//
// The degrees of freedom are those of the combined algorithm of Greenhall and Riley: one algorithm
// for the structure of a deviation (the order d of its differences: 2, HDEV 3; modified or not;
// overlapping or not) and the noise. It sums the squared correlations of the terms. Beyond
// kMostLags lags, the lags are widened in proportion: within 4 % of the full sum; a deviation's
// limits move by half of that at most. White phase noise has a sum of d + 1 lags.
//
// Over gaps: the pooled variance weights each piece by its terms M, so its degrees of freedom are
// (sum M)^2 / sum(M^2 / edf) over the pieces. That is the sum of theirs where pieces are of equal
// length, and slightly less where they are not.
//
// A deviation with fewer than kFewestDegrees is not reliable: its interval reaches from 0.57 to 3.7
// times its value, or farther. MTIE is a largest value, not a mean of squares: it has no such
// interval, and to ask for one is a programming error.
//
// Complexity: O(kMostLags) for each different length of a piece.
//
// Sources: C. A. Greenhall and W. J. Riley, "Uncertainty of stability variances based on finite
// differences", PTTI 2003; W. J. Riley, NIST SP 1065, 2008, section 5.4.
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const double edf = degrees_of_freedom(series, Deviation::kAdev, 1, NoiseType::kWhiteFm);
//   const Interval limits = deviation_interval(1e-9, edf);
#pragma once

#include <cstdint>

#include "evaluation/stability/noise_type.h"
#include "evaluation/stability/stability.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

inline constexpr double kConfidence = 0.95;
inline constexpr double kFewestDegrees = 3;
inline constexpr double kMostLags = 100;

// A deviation at m intervals of one piece of so many points, which must have a term.
double degrees_of_freedom(std::int64_t points, Deviation deviation, std::int64_t m,
                          NoiseType noise);
// The degrees of freedom of all pieces together; one piece must have a term.
double degrees_of_freedom(const TimeErrorSeries& series, Deviation deviation, std::int64_t m,
                          NoiseType noise);

// The limits of a deviation, in its unit; above 0 degrees.
Interval deviation_interval(double deviation, double degrees, double confidence = kConfidence);

}  // namespace simbench::evaluation
