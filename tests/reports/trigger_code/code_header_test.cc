#include "reports/trigger_code/code_header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CodeHeader, HasTheIntervalsOfTheCode) {
  // 0, +, 0, - ...: intervals of 1100 and 900 us.
  const TriggerCode code = TriggerCode::frequency(from_us(1000), 4, 2, from_us(100));
  const std::string text = code_header(code, "my_rig", 1e6);
  EXPECT_THAT(text, HasSubstr("coded trigger of my_rig"));
  EXPECT_THAT(text, HasSubstr("#define CODE_INTERVALS 32UL"));
  EXPECT_THAT(text, HasSubstr("static const uint16_t code_interval_ticks[CODE_INTERVALS] = {"));
  // The sequence begins with 0001: the first pulse is early, the second on the grid.
  EXPECT_THAT(text, HasSubstr("    1100, 900, 1100, 900, 1100, 1100, 900,"));
  EXPECT_THAT(text, Not(HasSubstr("1000,")));
}

TEST(CodeHeader, WideIntervalsTakeMoreBits) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 4, from_us(50));
  EXPECT_THAT(code_header(code, "my_rig", 16e6), HasSubstr("static const uint32_t"));
}

TEST(CodeHeader, ATimerThatIsTooSlowIsRefused) {
  const TriggerCode code = TriggerCode::position(from_ms(10), 4, from_us(50));
  EXPECT_THROW(code_header(code, "my_rig", 10), scenarios::InputError);
  EXPECT_THROW(code_header(code, "my_rig", 1e13), scenarios::InputError);
}

}  // namespace
}  // namespace simbench::reports
