#include "sim/clock/grid_walk.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kStep = 1000;

// A walk of small whole numbers, whose sums are exact.
double walk_step(double& state, std::int64_t index, double sign) {
  RandomStream draw(7, ComponentKey("walk"), static_cast<std::uint64_t>(index));
  state += sign * (draw.uniform(0, 1) < 0.5 ? -1 : 1);
  return state;
}

// Phases of the grid points -points to points, one step after the other.
std::vector<double> phases(std::int64_t points) {
  std::vector<double> all(static_cast<std::size_t>(2 * points + 1));
  double forward = 0;
  double backward = 0;
  for (std::int64_t i = 0; i < points; ++i) {
    const auto zero = static_cast<std::size_t>(points);
    const auto at = static_cast<std::size_t>(i);
    all[zero + at + 1] = all[zero + at] + walk_step(forward, i, 1);
    all[zero - at - 1] = all[zero - at] - walk_step(backward, -i - 1, -1);
  }
  return all;
}

TEST(GridWalkTest, IsTheSameInWhateverOrderItIsAsked) {
  constexpr std::int64_t kPoints = 30'000;
  const std::vector<double> expected = phases(kPoints);
  const GridWalk<double> walk(kStep, 0.0);
  const auto check = [&](std::int64_t point) {
    ASSERT_EQ(walk.phase_ns(point * kStep, walk_step),
              expected[static_cast<std::size_t>(point + kPoints)])
        << point;
  };
  // As a service does: far back at once, then forward, with looks a little behind.
  for (std::int64_t point = -kPoints + 1; point < kPoints - 1; ++point) {
    check(point);
    check(std::max(point - 70, -kPoints + 1));
  }
  RandomStream draw(1, "points");
  for (int i = 0; i < 2000; ++i) {
    check(static_cast<std::int64_t>(draw.uniform(-kPoints + 1, kPoints - 1)));
  }
}

TEST(GridWalkTest, CopiesShareWhatWasSampled) {
  constexpr std::int64_t kFar = 20'000;
  constexpr int kSteps = kFar - 1;
  const std::vector<double> expected = phases(kFar);
  int sampled = 0;
  const auto counted = [&sampled](double& state, std::int64_t index, double sign) {
    ++sampled;
    return walk_step(state, index, sign);
  };
  const auto first_point = [&](const GridWalk<double>& walk) {
    return walk.phase_ns((-kFar + 1) * kStep, counted);
  };
  const GridWalk<double> all_kept(kStep, 0.0, 5);
  EXPECT_EQ(first_point(all_kept), expected[1]);
  EXPECT_EQ(sampled, kSteps);
  const GridWalk<double> copy = all_kept;
  EXPECT_EQ(first_point(copy), expected[1]);
  EXPECT_EQ(copy.phase_ns(-kStep, counted), expected[kFar - 1]);
  EXPECT_EQ(sampled, kSteps) << "of five blocks, all of them are kept";

  const GridWalk<double> few_kept(kStep, 0.0);
  sampled = 0;
  first_point(few_kept);
  EXPECT_EQ(few_kept.phase_ns(-kStep, counted), expected[kFar - 1]);
  EXPECT_GT(sampled, kSteps) << "of two blocks, the first one is sampled anew";
}

TEST(GridWalkTest, IsLinearBetweenGridPoints) {
  const GridWalk<double> walk(kStep, 0.0);
  for (const std::int64_t point : {-4097, -4096, -1, 0, 1, 4095, 4096, 8192}) {
    const double a = walk.phase_ns(point * kStep, walk_step);
    const double b = walk.phase_ns((point + 1) * kStep, walk_step);
    EXPECT_DOUBLE_EQ(walk.phase_ns(point * kStep + kStep / 4, walk_step), a + (b - a) / 4) << point;
  }
}

}  // namespace
}  // namespace simbench::sim
