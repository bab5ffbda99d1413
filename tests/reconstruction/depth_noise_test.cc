#include "reconstruction/depth_noise.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace simbench::reconstruction {
namespace {

constexpr double kFocal = 430;
constexpr int kWidth = 400;
constexpr int kHeight = 250;
constexpr double kPixels = kWidth * kHeight;

scenarios::Studio quiet_studio() {
  scenarios::Studio studio;
  studio.stereo_baseline_mm = 95;
  studio.subpixel_error_px = 0.08;
  studio.missing_share = 0;
  studio.max_incidence_deg = 80;
  studio.min_distance_m = 0.4;
  studio.max_distance_m = 6;
  return studio;
}

SeenDepth wall(double depth_m, double incidence_deg = 0) {
  SeenDepth seen{DepthMap(kWidth, kHeight), {}};
  std::fill(seen.depth.depth_m.begin(), seen.depth.depth_m.end(), static_cast<float>(depth_m));
  seen.cos_incidence.assign(seen.depth.depth_m.size(),
                            static_cast<float>(std::cos(incidence_deg * std::numbers::pi / 180)));
  return seen;
}

struct Spread {
  double mean = 0;
  double sigma = 0;
  double share = 0;  // of the pixels that have a value
};

Spread spread_of(const DepthMap& map) {
  double sum = 0;
  double squares = 0;
  double count = 0;
  const double origin = *std::max_element(map.depth_m.begin(), map.depth_m.end());
  for (const float depth : map.depth_m) {
    if (depth == 0) continue;
    sum += depth - origin;
    squares += (depth - origin) * (depth - origin);
    ++count;
  }
  if (count == 0) return {};
  const double mean = sum / count;
  return {origin + mean, std::sqrt(squares / count - mean * mean), count / kPixels};
}

// By hand, of 0.08 px, 430 px and 95 mm: 0.00196 z^2.
double sigma_m(double depth_m) { return 0.08 / (430 * 0.095) * depth_m * depth_m; }

// 100000 pixels: a mean is within sigma / 316, a sigma within 0.22 % (one standard error).
TEST(DepthNoise, GrowsWithTheSquareOfTheDistance) {
  const scenarios::Studio studio = quiet_studio();
  for (const double depth : {0.5, 1.0, 2.0, 4.0, 5.5}) {
    SCOPED_TRACE(depth);
    const double sigma = sigma_m(depth);
    const Spread found = spread_of(measured_depth(wall(depth), studio, kFocal, {1, 2, 3}));
    EXPECT_NEAR(found.mean, depth, sigma * 0.016);
    EXPECT_NEAR(found.sigma, sigma, sigma * 0.011);
    EXPECT_EQ(found.share, 1);
  }
}

// 4.55 % of a normal law are farther than two sigma and 0.27 % farther than three.
TEST(DepthNoise, IsNormal) {
  const scenarios::Studio studio = quiet_studio();
  const double sigma = sigma_m(2);
  double two = 0;
  double three = 0;
  for (const float depth : measured_depth(wall(2), studio, kFocal, {1, 2, 3}).depth_m) {
    two += std::abs(depth - 2) > 2 * sigma ? 1 : 0;
    three += std::abs(depth - 2) > 3 * sigma ? 1 : 0;
  }
  EXPECT_NEAR(two / kPixels, 0.0455, 0.0033);    // 5 standard errors
  EXPECT_NEAR(three / kPixels, 0.0027, 0.0008);  // likewise
}

TEST(DepthNoise, NeighboursAreIndependent) {
  const scenarios::Studio studio = quiet_studio();
  const DepthMap map = measured_depth(wall(2), studio, kFocal, {1, 2, 3});
  const double variance = std::pow(sigma_m(2), 2);
  for (const std::size_t lag : {std::size_t{1}, std::size_t{kWidth}}) {
    double products = 0;
    for (std::size_t i = lag; i < map.depth_m.size(); ++i) {
      products += (map.depth_m[i] - 2.0) * (map.depth_m[i - lag] - 2.0);
    }
    EXPECT_NEAR(products / kPixels / variance, 0, 0.016) << lag;
  }
}

TEST(DepthNoise, WithoutErrorDepthsAreExact) {
  scenarios::Studio studio = quiet_studio();
  studio.subpixel_error_px = 0;
  const SeenDepth seen = wall(3.21);
  EXPECT_EQ(measured_depth(seen, studio, kFocal, {}).depth_m, seen.depth.depth_m);
}

TEST(DepthNoise, AShareIsMissingByChance) {
  scenarios::Studio studio = quiet_studio();
  for (const double share : {0.0, 0.02, 0.5, 1.0}) {
    studio.missing_share = share;
    const Spread found = spread_of(measured_depth(wall(2), studio, kFocal, {1, 0, 0}));
    EXPECT_NEAR(1 - found.share, share, 5 * std::sqrt(share * (1 - share) / kPixels));
  }
}

TEST(DepthNoise, SteepSurfacesGiveNothing) {
  const scenarios::Studio studio = quiet_studio();
  const auto share = [&](double incidence) {
    return spread_of(measured_depth(wall(2, incidence), studio, kFocal, {})).share;
  };
  EXPECT_EQ(share(0), 1);
  EXPECT_EQ(share(79.9), 1);
  EXPECT_EQ(share(80.1), 0);
  EXPECT_EQ(share(90), 0);
}

TEST(DepthNoise, WhatIsOutOfRangeGivesNothing) {
  const scenarios::Studio studio = quiet_studio();
  const auto share = [&](double depth) {
    return spread_of(measured_depth(wall(depth), studio, kFocal, {})).share;
  };
  EXPECT_EQ(share(0.39), 0);
  EXPECT_EQ(share(0.41), 1);
  EXPECT_EQ(share(5.99), 1);
  EXPECT_EQ(share(6.01), 0);
}

// With an error as large as the depth, one in six falls behind the camera: it has no value.
TEST(DepthNoise, NoDepthIsNegative) {
  scenarios::Studio studio = quiet_studio();
  studio.subpixel_error_px = kFocal * 0.095 / 2;  // sigma(2 m) is 2 m
  const DepthMap map = measured_depth(wall(2), studio, kFocal, {});
  EXPECT_GE(*std::min_element(map.depth_m.begin(), map.depth_m.end()), 0);
  EXPECT_NEAR(spread_of(map).share, 0.8413, 0.006);
}

TEST(DepthNoise, NothingSeenStaysNothing) {
  SeenDepth seen = wall(2);
  for (std::size_t i = 0; i < seen.depth.depth_m.size(); i += 2) {
    seen.depth.depth_m[i] = 0;
    seen.cos_incidence[i] = 0;
  }
  const DepthMap map = measured_depth(seen, quiet_studio(), kFocal, {});
  EXPECT_EQ(map.width, kWidth);
  EXPECT_EQ(map.height, kHeight);
  for (std::size_t i = 0; i < map.depth_m.size(); ++i) {
    EXPECT_EQ(map.depth_m[i] > 0, i % 2 == 1);
  }
  EXPECT_TRUE(measured_depth({}, quiet_studio(), kFocal, {}).depth_m.empty());
}

TEST(DepthNoise, TheSameKeyIsTheSameMap) {
  const scenarios::Studio studio = quiet_studio();
  const auto map = [&](const NoiseKey& key) {
    return measured_depth(wall(2), studio, kFocal, key).depth_m;
  };
  const std::vector<float> once = map({1, 2, 3});
  EXPECT_EQ(once, map({1, 2, 3}));
  for (const NoiseKey& other : {NoiseKey{2, 2, 3}, NoiseKey{1, 3, 3}, NoiseKey{1, 2, 4},
                                NoiseKey{1, 3, 2}, NoiseKey{1, 2, -3}}) {
    const std::vector<float> different = map(other);
    double products = 0;
    for (std::size_t i = 0; i < once.size(); ++i) {
      products += (once[i] - 2.0) * (different[i] - 2.0);
    }
    const double variance = std::pow(sigma_m(2), 2);
    EXPECT_NEAR(products / kPixels / variance, 0, 0.016);
  }
}

// Limits take pixels away and leave the others as they were.
TEST(DepthNoise, LimitsMoveNoOtherPixelsNoise) {
  SeenDepth seen = wall(2);
  for (std::size_t i = 0; i < seen.depth.depth_m.size(); i += 3) seen.cos_incidence[i] = 0.1F;
  scenarios::Studio strict = quiet_studio();
  scenarios::Studio lenient = quiet_studio();
  lenient.max_incidence_deg = 90;
  const DepthMap with = measured_depth(seen, strict, kFocal, {1, 2, 3});
  const DepthMap without = measured_depth(seen, lenient, kFocal, {1, 2, 3});
  for (std::size_t i = 0; i < with.depth_m.size(); ++i) {
    ASSERT_EQ(with.depth_m[i], i % 3 == 0 ? 0 : without.depth_m[i]);
    ASSERT_GT(without.depth_m[i], 0);
  }
}

}  // namespace
}  // namespace simbench::reconstruction
