#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/advice/advice_report.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kSetsPerDay = 1e6;

std::vector<RareResult> results() {
  RareResult found{
      .event = "spread above 0.1 ms", .bound_ms = 0.1, .sets_per_day = kSetsPerDay, .estimate = {}};
  found.estimate.probability = 2e-5;
  found.estimate.low = 1e-5;
  found.estimate.high = 4e-5;
  found.estimate.runs = 5000;
  found.estimate.repeats = {1e-5, 2e-5, 3e-5};
  RareResult below{
      .event = "set of several pulses", .bound_ms = 4, .sets_per_day = kSetsPerDay, .estimate = {}};
  below.estimate.is_below = true;
  below.estimate.high = 3e-8;
  below.estimate.runs = 1200;
  return {found, below};
}

TEST(RareReport, GivesProbabilityAndSetsPerDayWithTheirIntervals) {
  const Block block = rare_block("How often", results());
  EXPECT_EQ(block.heading, "How often");
  ASSERT_TRUE(block.table);
  ASSERT_EQ(block.table->rows.size(), 2U);
  EXPECT_THAT(block.table->rows[0],
              ElementsAre("spread above 0.1 ms", "2.00e-05", "[1.00e-05, 4.00e-05]", "20.0",
                          "[10.0, 40.0]", count_text(5000), "3"));
}

TEST(RareReport, HasNoIntervalOfWhatWasNotReached) {
  const Block block = rare_block("How often", results());
  EXPECT_THAT(block.table->rows[1],
              ElementsAre("set of several pulses", "below about 3.00e-08", "-",
                          "below about 0.0300", "-", count_text(1200), "0"));
}

TEST(RareReport, SaysTooRareWithoutAGuide) {
  std::vector<RareResult> none = {results()[1]};
  none[0].estimate.high = evaluation::kNan;
  const Block block = rare_block("How often", none);
  EXPECT_EQ(block.table->rows[0][1], "too rare");
}

TEST(RareReport, SaysWhatItsIntervalIs) {
  const std::string text =
      plain({.title = "t", .head = {}, .blocks = {rare_block("h", results())}});
  EXPECT_THAT(text, HasSubstr("independent repeats"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(RareReport, IsJsonWithNullForWhatDoesNotExist) {
  const auto json = nlohmann::json::parse(file_text(rare_json(results())));
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["event"], "spread above 0.1 ms");
  EXPECT_EQ(json[0]["bound_ms"], 0.1);
  EXPECT_EQ(json[0]["probability"], 2e-5);
  EXPECT_DOUBLE_EQ(json[0]["per_day"], 20);
  EXPECT_DOUBLE_EQ(json[0]["per_day_low"], 10);
  EXPECT_DOUBLE_EQ(json[0]["per_day_high"], 40);
  EXPECT_EQ(json[0]["is_below"], false);
  EXPECT_EQ(json[0]["runs"], 5000);
  EXPECT_EQ(json[0]["repeats"], 3);
  EXPECT_TRUE(json[1]["probability"].is_null());
  EXPECT_TRUE(json[1]["per_day_low"].is_null());
  EXPECT_EQ(json[1]["high"], 3e-8);
  EXPECT_EQ(json[1]["is_below"], true);
}

}  // namespace
}  // namespace simbench::reports
