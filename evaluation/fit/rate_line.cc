#include "evaluation/fit/rate_line.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr int kRateRounds = 3;
constexpr double kLowest = 0;
constexpr double kLowerQuartile = 0.25;
constexpr double kMuchBetter = 0.5;
// The walk's variance from one point to the next, in units of the jitter's.
constexpr std::array<double, 9> kWalkShares = {0, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1, 4, 16, 64, 256};
// How much less the mean of a walk over a block varies than the walk in its middle, in units of its
// variance from one block to the next: 1/2 - 1/3.
constexpr double kMeanOfWalk = 1.0 / 6;
constexpr double kStampRoundingMs = 1e-6;  // stamps are of whole nanoseconds

struct BlockPoints {
  std::vector<double> x;
  std::vector<double> y;
};

// The mean time of each block, and this quantile of its heights over a line of this slope.
BlockPoints block_points(std::span<const double> x, std::span<const double> y, double at,
                         double slope) {
  const std::size_t blocks =
      std::clamp(x.size() / kRateBlockFrames, kFewestRateBlocks, kMostRateBlocks);
  BlockPoints points;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t begin = block * x.size() / blocks;
    const std::size_t end = (block + 1) * x.size() / blocks;
    const double mean_x = mean_of(x.subspan(begin, end - begin));
    std::vector<double> heights;
    for (std::size_t i = begin; i < end; ++i) heights.push_back(y[i] - slope * (x[i] - mean_x));
    points.x.push_back(mean_x);
    points.y.push_back(quantile(std::move(heights), at));
  }
  return points;
}

// A line for one share of the walk.
struct WeighedSlope {
  double slope = 0;
  double variance = 0;
  double log_likelihood = 0;
};

// `design`: a column of ones, and the times in mean distances of two points, ascending.
WeighedSlope weighed_slope(const Eigen::MatrixX2d& design, const Eigen::VectorXd& y,
                           double walk_share) {
  const Eigen::Index size = y.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      covariance(i, j) += walk_share * (design(std::min(i, j), 1) - design(0, 1) + 1);
    }
    covariance(i, i) -= walk_share * kMeanOfWalk;
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::Matrix2d information = design.transpose() * root.solve(design);
  const Eigen::Vector2d line = information.inverse() * (design.transpose() * root.solve(y));
  const Eigen::VectorXd residual = y - design * line;
  const auto freedom = static_cast<double>(size - 2);
  const double scatter =
      residual.dot(root.solve(residual)) + freedom * kStampRoundingMs * kStampRoundingMs;
  const double log_determinant = 2 * root.matrixLLT().diagonal().array().log().sum();
  return {.slope = line[1],
          .variance = scatter / freedom * information.inverse()(1, 1),
          .log_likelihood = -(log_determinant + std::log(information.determinant()) +
                              freedom * std::log(scatter)) /
                            2};
}

// The line for the share of the walk that the points speak for.
RateLine likeliest_line(const BlockPoints& points) {
  const auto size = static_cast<Eigen::Index>(points.x.size());
  const double mean_x = mean_of(points.x);
  const double distance = (points.x.back() - points.x.front()) / static_cast<double>(size - 1);
  Eigen::MatrixX2d design(size, 2);
  Eigen::VectorXd levels(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    design(i, 0) = 1;
    design(i, 1) = (points.x[at] - mean_x) / distance;
    levels[i] = points.y[at];
  }
  WeighedSlope best = weighed_slope(design, levels, kWalkShares.front());
  for (const double share : kWalkShares) {
    const WeighedSlope slope = weighed_slope(design, levels, share);
    if (slope.log_likelihood > best.log_likelihood) best = slope;
  }
  return {.slope = best.slope / distance,
          .error = std::sqrt(best.variance) / distance,
          .freedom = static_cast<double>(size - 3),
          .mean_x = mean_x,
          .mean_y = mean_of(points.y),
          .plain_slope = fit_line(points.x, points.y).slope};
}

RateLine line_at(std::span<const double> x, std::span<const double> y, double at) {
  BlockPoints points = block_points(x, y, at, 0);
  for (int round = 1; round < kRateRounds; ++round) {
    points = block_points(x, y, at, fit_line(points.x, points.y).slope);
  }
  return likeliest_line(points);
}

}  // namespace

RateLine rate_line(std::span<const double> x, std::span<const double> y) {
  const RateLine quartile = line_at(x, y, kLowerQuartile);
  const RateLine lowest = line_at(x, y, kLowest);
  return lowest.error <= kMuchBetter * quartile.error ? lowest : quartile;
}

}  // namespace simbench::evaluation
