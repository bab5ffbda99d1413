#include "reconstruction/desync_pattern.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/nonempty.h"
#include "tests/reconstruction/studio_scenario.h"

namespace simbench::reconstruction {
namespace {

TEST(DesyncPattern, SpreadsTheHostsOverExactlyTheStatedTime) {
  const scenarios::Scenario scenario = studio_scenario();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto set = desynchronised_set(scenario, seed, 547, 10, 3);
    EXPECT_NEAR(set.spread_ms(), 547, 1e-9) << seed;
    double first = 1e9;
    double last = -1e9;
    for (const auto& camera : nonempty(set.cameras)) {
      ASSERT_TRUE(camera.has_value());
      EXPECT_EQ(camera->counter, 3U);
      first = std::min(first, camera->mid_exposure_s);
      last = std::max(last, camera->mid_exposure_s);
    }
    EXPECT_NEAR((first + last) / 2, 10, 1e-12);
  }
}

TEST(DesyncPattern, CamerasOfOneHostExposeTogether) {
  const scenarios::Scenario scenario = studio_scenario();
  const auto set = desynchronised_set(scenario, 1, 100, 0, 0);
  std::set<double> instants;
  for (std::size_t camera = 0; camera < nonempty(set.cameras).size(); ++camera) {
    const std::size_t first_of_host = camera / 3 * 3;
    EXPECT_EQ(set.cameras[camera]->mid_exposure_s, set.cameras[first_of_host]->mid_exposure_s);
    instants.insert(set.cameras[camera]->mid_exposure_s);
  }
  EXPECT_EQ(instants.size(), 6U);
}

// The one pattern pairs the points of a curve.
TEST(DesyncPattern, IsTheSamePatternAtEveryDesynchronisation) {
  const scenarios::Scenario scenario = studio_scenario();
  const auto small = desynchronised_set(scenario, 4, 10, 0, 0);
  const auto large = desynchronised_set(scenario, 4, 200, 0, 0);
  for (std::size_t camera = 0; camera < 18; ++camera) {
    EXPECT_NEAR(20 * small.cameras[camera]->mid_exposure_s, large.cameras[camera]->mid_exposure_s,
                1e-12);
  }
  EXPECT_EQ(desynchronised_set(scenario, 4, 0, 5, 0).spread_ms(), 0);
}

}  // namespace
}  // namespace simbench::reconstruction
