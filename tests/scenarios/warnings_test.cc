// Warnings about settings that are possible but suspicious; those of the distribution's scenarios
// are tested beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(WireWarnings, AnAsymmetryThatWouldMakeAMessageFasterThanLight) {
  const auto warned = [](const char* sigma_ms) {
    return warnings(
        load_scenario("18cam_6host_45fps_lan", {{"/network/asymmetry_sigma_ms", sigma_ms}}));
  };
  EXPECT_THAT(warned("0.01"),
              ElementsAre(AllOf(HasSubstr("/network/asymmetry_sigma_ms=0.01: links differ by 0.01 "
                                          "ms"),
                                HasSubstr("faster than light, and stops at 0"))));
  EXPECT_THAT(warned("0.0005"), IsEmpty());
}

TEST(OscillatorWarnings, AWalkOrARampThatMayGetToItsLimit) {
  const auto warned = [](const char* pointer, const char* value, const char* frames) {
    return warnings(
        load_scenario("18cam_6host_45fps", {{pointer, value}, {"/timeline/frames", frames}}));
  };
  // 1e6 ppb in the first second, its root of time times as much later: 2.7 % after 727 s.
  EXPECT_THAT(
      warned("/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s", "1e6", "32000"),
      ElementsAre(AllOf(HasSubstr("/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s=1e6: the "
                                  "walk's sigma moves the frequency by 2.7 % in the 728 s"),
                        HasSubstr("no further than 5 %"))));
  EXPECT_THAT(warned("/cameras/oscillator/random_walk_ppb_per_sqrt_s", "1e6", "480"), IsEmpty());
  // 1000 ppm/h take 50 h.
  const auto ramp_warned = [](const char* frames) {
    return warnings(load_scenario(
        "3cam_1host_30fps",
        {{"/cameras/oscillator/ramp_ppm_per_hour", "-1000"}, {"/timeline/frames", frames}}));
  };
  EXPECT_THAT(
      ramp_warned("5500000"),
      ElementsAre(HasSubstr("/cameras/oscillator/ramp_ppm_per_hour=-1000: the ramp moves")));
  EXPECT_THAT(ramp_warned("5300000"), IsEmpty());
}

}  // namespace
}  // namespace simbench::scenarios
