#include "evaluation/certificates/assumptions.h"

#include <gmock/gmock.h>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using testing::DoubleEq;

Assumptions assumed(const std::vector<scenarios::Override>& changes) {
  return assumptions_of(scenarios::load_scenario("3cam_1host_30fps", changes));
}

TEST(Assumptions, ADataSheetsRateCountsWhereTheLawIsNarrower) {
  const Assumptions found = assumed({{"/hosts/clock/oscillator/skew_sigma_ppm", "1"},
                                     {"/cameras/oscillator/skew_sigma_ppm", "1"}});
  EXPECT_EQ(found.host_rate_ppm, Assumptions::kDataSheet_ppm);
  EXPECT_EQ(found.camera_rate_ppm, Assumptions::kDataSheet_ppm);
}

// Five sigmas, and what the rate gains in time.
TEST(Assumptions, RatesHoldTheLawOfTheWorld) {
  EXPECT_EQ(assumed({{"/hosts/clock/oscillator/skew_sigma_ppm", "30"}}).host_rate_ppm, 150);
  EXPECT_EQ(assumed({{"/cameras/oscillator/skew_sigma_ppm", "20"},
                     {"/cameras/oscillator/self_heating_ppm", "-7.5"}})
                .camera_rate_ppm,
            108);
  EXPECT_EQ(assumed({{"/hosts/clock/skew_of_host_ppm", "[-220]"},
                     {"/hosts/clock/oscillator/skew_sigma_ppm", "30"}})
                .host_rate_ppm,
            220);
  EXPECT_EQ(assumed({{"/hosts/clock/oscillator/skew_sigma_ppm", "10"},
                     {"/hosts/clock/oscillator/ramp_ppm_per_hour", "-2"}})
                .host_rate_ppm,
            98);
}

TEST(Assumptions, StampsAreAsCoarseAsTheWorldMakesThem) {
  const Assumptions found = assumed({{"/hosts/clock/tick_ms", "15.625"},
                                     {"/hosts/clock/resolution_ms", "1"},
                                     {"/network/switch_clock_error_ns", "50"},
                                     {"/cameras/sensor_stamp_jitter_sigma_us", "3"}});
  EXPECT_THAT(found.host_stamp_ms, DoubleEq(15.625 + 1 + 1e-6 + 8 * 50e-6));
  EXPECT_THAT(found.sensor_stamp_us, DoubleEq(25));
  EXPECT_FALSE(found.estimated_stamp_ms);
}

// A rig of several models: the widest law among its groups.
TEST(Assumptions, EveryGroupOfCamerasCounts) {
  const Assumptions found = assumed(
      {{"/usb/cameras_per_controller", "1"},
       {"/cameras/groups",
        R"([{"count": 2}, {"count": 1, "skew_sigma_ppm": 40, "sensor_stamp_jitter_sigma_us": 9}])"}});
  EXPECT_EQ(found.camera_rate_ppm, 200);
  EXPECT_THAT(found.sensor_stamp_us, DoubleEq(73));
}

}  // namespace
}  // namespace simbench::evaluation
