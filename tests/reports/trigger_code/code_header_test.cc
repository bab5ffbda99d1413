#include "reports/trigger_code/code_header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

TriggerCodeResult rig(const TriggerCode& code, std::vector<CodeMode> modes = {}) {
  return {.scenario = "my_rig",
          .model = {},
          .code = code,
          .settings = {},
          .forecast = {},
          .modes = std::move(modes)};
}

void refuses(const TriggerCodeResult& result, double timer_hz, const char* part) {
  try {
    code_header(result, timer_hz);
    ADD_FAILURE() << timer_hz;
  } catch (const scenarios::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(part));
  }
}

TEST(CodeHeader, HasTheIntervalsOfTheCode) {
  // 0, +, 0, - ...: intervals of 1100 and 900 us.
  const TriggerCode code = TriggerCode::frequency(from_us(1000), 4, 2, from_us(100));
  const std::string text = code_header(rig(code), 1e6);
  EXPECT_THAT(text, HasSubstr("coded trigger of my_rig"));
  EXPECT_THAT(text, HasSubstr("#define CODE_INTERVALS 32UL"));
  EXPECT_THAT(text, HasSubstr("static const uint16_t code_interval_ticks[CODE_INTERVALS] = {"));
  // The sequence begins with 0001: the first pulse is early, the second on the grid.
  EXPECT_THAT(text, HasSubstr("    1100, 900, 1100, 900, 1100, 1100, 900,"));
  EXPECT_THAT(text, Not(HasSubstr("1000,")));
}

TEST(CodeHeader, WideIntervalsTakeMoreBits) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 4, from_us(50));
  EXPECT_THAT(code_header(rig(code), 16e6), HasSubstr("static const uint32_t"));
}

TEST(CodeHeader, ATimerThatNoIntervalFitsIsRefused) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 4, from_us(50));
  refuses(rig(code), 1e13, "allowed 1 to 4294967295");
}

// Steps of 100 us need ticks of 16.7 us; pulses left out are a period of 10 ms apart.
TEST(CodeHeader, ATimerThatLosesTheCodeIsRefused) {
  const TriggerCode moved = TriggerCode::position(from_ms(10), 4, from_us(50));
  refuses(rig(moved), 59'999, "allowed at least 60000: the code moves them by 100 us");
  EXPECT_NO_THROW(code_header(rig(moved), 60'000));
  const TriggerCode gated = TriggerCode::missing(from_ms(10), 4, 2);
  refuses(rig(gated), 599, "allowed at least 600");
  EXPECT_NO_THROW(code_header(rig(gated), 600));
}

// Shifts of 60 us are 4 ticks of 16 us: intervals of 9.872 ms in place of 9.88.
TEST(CodeHeader, IntervalsThatRoundingPutsOutOfTheWindowAreRefused) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 4, from_us(60));
  const auto within = [&](Nanoseconds shortest, bool is_own) {
    CodeMode mode{.camera = "any",
                  .mode = "slave",
                  .stream = "depth",
                  .is_own = is_own,
                  .limits = {.shortest = shortest, .longest = from_us(10'200)}};
    return rig(code, {mode});
  };
  refuses(within(from_us(9'875), true), 62'500,
          "are 9872 to 10128 us apart, allowed 9875 to 10200");
  EXPECT_NO_THROW(code_header(within(from_us(9'875), false), 62'500));
  EXPECT_NO_THROW(code_header(within(from_us(9'872), true), 62'500));
  EXPECT_NO_THROW(code_header(within(from_us(9'875), true), 1e6));
}

}  // namespace
}  // namespace simbench::reports
