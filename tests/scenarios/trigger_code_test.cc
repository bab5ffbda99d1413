#include "scenarios/trigger_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCoded = "18cam_6host_90fps_coded";

Scenario loaded(const std::vector<Override>& overrides) { return load_scenario(kCoded, overrides); }

std::string code_refusal(const std::vector<Override>& overrides) {
  try {
    loaded(overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// In genlock at half of the 90 Hz mode.
std::vector<Override> genlock(std::vector<Override> more) {
  more.push_back({"/cameras/sync_mode", "\"genlock\""});
  more.push_back({"/trigger/rate_error_ppm", "0"});
  return more;
}

TEST(TriggerCodeOfScenario, HasWhatIsStated) {
  const Scenario scenario = loaded({});
  const TriggerCode code = *trigger_code(scenario.trigger);
  EXPECT_EQ(code.length(), 4096);
  EXPECT_EQ(code.period(), from_ns(1e9 / (90 * 1.0005)));
  EXPECT_EQ(code.range(), from_us(100));
  EXPECT_FALSE(trigger_code(load_scenario("18cam_6host_45fps").trigger).has_value());
}

TEST(TriggerCodeOfScenario, ASlaveTakesIntervalsNearItsMode) {
  const Scenario scenario = loaded({});
  const CodeLimits limits = code_limits(scenario, *scenario.scored_stream());
  EXPECT_EQ(limits.pulses_per_frame, 1);
  EXPECT_FALSE(limits.may_leave_out);
  EXPECT_NEAR(to_ns(limits.shortest), 1e9 / 90.9, 1.1) << "1 % fast";
  EXPECT_NEAR(to_ns(limits.longest), 1e9 / 89.1, 1.1) << "1 % slow";
  // Pulses 500 ppm fast leave 104.5 us until the shortest interval: a shift of half of that.
  EXPECT_EQ(code_refusal({{"/trigger/code/shift_us", "52"}}), "");
  EXPECT_THAT(code_refusal({{"/trigger/code/shift_us", "53"}}),
              AllOf(HasSubstr("/trigger/code/shift_us=53: found 53"),
                    HasSubstr("10999.6 to 11211.6 us apart, allowed at most 52.2"),
                    HasSubstr("takes 11001.1 to 11223.3 us in sync mode \"slave\"")));
}

TEST(TriggerCodeOfScenario, AnExposureEndsBeforeTheNextPulse) {
  EXPECT_THAT(code_refusal({{"/cameras/exposure_ms", "11.05"}}),
              HasSubstr("/trigger/code/shift_us: found 50"));
  EXPECT_EQ(code_refusal({{"/cameras/exposure_ms", "11"}}), "");
}

TEST(TriggerCodeOfScenario, GenlockIgnoresTwoFrameTimes) {
  // 45 Hz: two mode periods less the guard of 2 %, 21780 us on a slow clock.
  const std::vector<Override> half = genlock({{"/trigger/rate_hz", "45"}});
  const Scenario scenario = loaded(half);
  const CodeLimits limits = code_limits(scenario, *scenario.scored_stream());
  EXPECT_EQ(limits.pulses_per_frame, 1);
  EXPECT_TRUE(limits.may_leave_out);
  EXPECT_NEAR(to_ns(limits.shortest), 2e9 / 90 * 0.98 * 1.0001, 1.1);
  auto wide = half;
  wide.push_back({"/trigger/code/shift_us", "222"});
  EXPECT_THAT(code_refusal(wide), AllOf(HasSubstr("allowed at most 221"),
                                        HasSubstr("a /trigger/rate_hz of at most 44.99")));
  // At the mode's full rate one pulse in two is answered, and two intervals count.
  const Scenario full = loaded(genlock({}));
  EXPECT_EQ(code_limits(full, *full.scored_stream()).pulses_per_frame, 2);
  // Without a guard a half-rate trigger has no room for a shift.
  auto unguarded = half;
  unguarded.push_back({"/cameras/genlock_guard_fraction", "0"});
  EXPECT_THAT(code_refusal(unguarded), AllOf(HasSubstr("allowed no shift at all"),
                                             HasSubstr("a /trigger/rate_hz of at most 44.79")));
}

TEST(TriggerCodeOfScenario, OnlyACameraThatWaitsTakesLeftOutPulses) {
  const std::string missing = R"({"kind": "missing", "order": 8, "pulses_per_symbol": 4})";
  EXPECT_THAT(code_refusal({{"/trigger/code", missing}, {"/trigger/code/shift_us", "0"}}),
              AllOf(HasSubstr("/trigger/code/kind: found \"missing\", allowed \"position\" or "
                              "\"frequency\" in sync mode \"slave\""),
                    HasSubstr("\"genlock\" waits")));
  const auto half = genlock(
      {{"/trigger/rate_hz", "45"}, {"/trigger/code", missing}, {"/trigger/code/shift_us", "0"}});
  EXPECT_EQ(code_refusal(half), "");
  EXPECT_THAT(code_refusal(genlock({{"/trigger/code", missing}, {"/trigger/code/shift_us", "0"}})),
              HasSubstr("answers one in 2 pulses"));
}

TEST(TriggerCodeOfScenario, CamerasThatFollowNothingHaveNoCode) {
  EXPECT_THAT(code_refusal({{"/cameras/sync_mode", "\"default\""}}),
              HasSubstr("/trigger/code: found a code, allowed null in sync mode \"default\": no "
                        "stream follows the pulses; in \"slave\", \"full_slave\", \"genlock\" one "
                        "would"));
}

TEST(TriggerCodeOfScenario, MembersBelongToTheirKind) {
  EXPECT_THAT(code_refusal({{"/trigger/code/shift_us", "0"}}),
              HasSubstr("found 0, allowed more than 0 of kind \"position\""));
  EXPECT_THAT(code_refusal({{"/trigger/code/pulses_per_symbol", "2"}}),
              HasSubstr("found 2, allowed 1 of kind \"position\""));
  EXPECT_THAT(code_refusal({{"/trigger/code/kind", "\"frequency\""}}),
              HasSubstr("/trigger/code/pulses_per_symbol: found 1, allowed an even number"));
  EXPECT_THAT(code_refusal({{"/trigger/code/kind", "\"missing\""}}),
              HasSubstr("/trigger/code/shift_us: found 50, allowed 0 of kind \"missing\""));
  EXPECT_THAT(code_refusal({{"/trigger/code/shift_us", "2000"}}),
              HasSubstr("pulses that are 11105.6 us apart must stay in their order"));
  EXPECT_THAT(code_refusal({{"/trigger/code/order", "3"}}),
              HasSubstr("found 3, allowed a whole number from 4 to 16"));
}

TEST(TriggerCodeOfScenario, FrequencyHasAShiftOfTheInterval) {
  const std::string frequency =
      R"({"kind": "frequency", "order": 10, "shift_us": 100, "pulses_per_symbol": 2})";
  EXPECT_EQ(code_refusal({{"/trigger/code", frequency}}), "");
  EXPECT_THAT(code_refusal({{"/trigger/code", frequency}, {"/trigger/code/shift_us", "106"}}),
              HasSubstr("allowed at most 104.4"));
}

TEST(TriggerCodeOfScenario, DistancesOverSeveralPulses) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 5, from_us(50));
  const CodeDistances one = code_distances(code, 1);
  EXPECT_EQ(one.shortest, code.shortest_interval());
  EXPECT_EQ(one.longest, code.longest_interval());
  const CodeDistances two = code_distances(code, 2);
  EXPECT_EQ(two.shortest, from_us(19'900));
  EXPECT_EQ(two.longest, from_us(20'100));
}

}  // namespace
}  // namespace simbench::scenarios
