#include "reports/trigger_code/code_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TriggerCodeResult sample_code() {
  TriggerCodeResult result{.scenario = "my_rig",
                           .model = {.kind = scenarios::CodeKind::kPosition,
                                     .order = 5,
                                     .shift_us = 50,
                                     .pulses_per_symbol = 1},
                           .code = TriggerCode::position(from_ms(10), 5, from_us(50)),
                           .settings = {},
                           .forecast = {.places = 32,
                                        .found = 32,
                                        .frames_median = 20,
                                        .frames_worst = 23,
                                        .pulses_worst = 23,
                                        .union_bound = 1e-20},
                           .modes = {}};
  result.modes.push_back({.camera = "Camera",
                          .mode = "slave",
                          .stream = "depth",
                          .mode_rate_hz = 100,
                          .is_own = true,
                          .limits = {.shortest = from_us(9900), .longest = from_us(10'100)},
                          .frames_per_s = 100,
                          .problem = ""});
  return result;
}

TEST(CodeReport, HasTheCodeTheSearchAndTheModes) {
  const std::string text = plain(trigger_code_document(sample_code()));
  EXPECT_THAT(text, AllOf(HasSubstr("each pulse 50 us early or late"),
                          HasSubstr("9900.0 to 10100.0 us, of 10000.0 us without the code"),
                          HasSubstr("0.23"), HasSubstr("slave (own)"),
                          HasSubstr("follows every pulse"), Not(HasSubstr("NOT"))));
}

TEST(CodeReport, ACodeThatIsNotFoundIsAWarning) {
  TriggerCodeResult result = sample_code();
  result.forecast.found = 0;
  EXPECT_THAT(plain(trigger_code_document(result)),
              HasSubstr("From 32 of 32 places a camera does NOT find its place"));
}

TEST(CodeReport, JsonHasNullWhereThereIsNothing) {
  TriggerCodeResult result = sample_code();
  result.forecast.union_bound = std::numeric_limits<double>::quiet_NaN();
  result.modes[0].problem = "found too much";
  result.modes[0].limits.longest = Nanoseconds::max();
  const auto json = nlohmann::json::parse(trigger_code_json(result));
  EXPECT_EQ(json["code"]["length_pulses"], 32);
  EXPECT_TRUE(json["search"]["union_bound"].is_null());
  EXPECT_EQ(json["modes"][0]["follows"], false);
  EXPECT_TRUE(json["modes"][0]["frames_per_s"].is_null());
  EXPECT_TRUE(json["modes"][0]["takes_to_us"].is_null());
}

}  // namespace
}  // namespace simbench::reports
