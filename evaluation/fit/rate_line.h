// The line under a stream's arrivals, with an honest error of its slope.
//
// Arrivals are late, never early, and a few are very late. Up to kMostRateBlocks blocks of
// successive frames have one point each: the mean time, and the lower quartile of the heights over
// the line (which is found in rounds, so that the slope within a block does not count as delay).
// The quartile is moved neither by late frames nor by single ones that seem early, as the edge of a
// hull is. Delays with a sharp edge have a better point, the lowest height of the block; it is used
// if that makes the error at most half as large, so that the choice does not flatter the error.
//
// The points scatter about the line for two reasons: each on its own (jitter), and as a random walk
// (a rate that wanders, delays that change for a while). The line is that of generalised least
// squares; the walk's share is the one of restricted maximum likelihood. The error therefore grows
// where neighbouring points deviate together. Its degrees of freedom are the points less three.
//
// x and y in ms, x ascending, as many of each, 8 or more. Complexity: O(n log n).
// Source: Patterson and Thompson 1971 (restricted likelihood); check: RateLine.* in the tests.
//
//   const std::vector<double> device_ms(300), distance_ms(300);
//   const RateLine line = rate_line(device_ms, distance_ms);
//   print(line.slope, line.error, line.freedom);
#pragma once

#include <cstddef>
#include <span>

namespace simbench::evaluation {

inline constexpr std::size_t kFewestRateBlocks = 4;
inline constexpr std::size_t kMostRateBlocks = 16;
inline constexpr std::size_t kRateBlockFrames = 12;  // at least, where that leaves enough blocks

struct RateLine {
  double slope = 0;    // of y over x
  double error = 0;    // standard error of the slope
  double freedom = 0;  // degrees of freedom of the error, Student's
  double mean_x = 0;
  double mean_y = 0;  // of the points
  // By plain least squares: follows the points, also where a walk makes the rate uncertain.
  double plain_slope = 0;
  double at(double x) const { return mean_y + plain_slope * (x - mean_x); }
};

RateLine rate_line(std::span<const double> x, std::span<const double> y);

}  // namespace simbench::evaluation
