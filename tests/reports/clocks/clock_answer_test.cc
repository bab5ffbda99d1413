#include <gmock/gmock.h>

#include "reports/clocks/clock_report.h"
#include "tests/reports/sample_clocks.h"
#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string clock_answer_of(const evaluation::Results& results) {
  return whole_text(clock_answer(results));
}

// "good" has 0.5, 1 and 3 ms of everything, and comes below 0.1 ms in one seed of three.
TEST(ClockAnswer, SaysWhoIsBestAndWhenItIsInSync) {
  const std::string text = clock_answer_of(sample_clock_results().results);
  EXPECT_THAT(text, StartsWith("good is the only host_sync here that a rig can run, and keeps the "
                               "clocks: 1.00 ms apart, mean in time"));
  EXPECT_THAT(text, HasSubstr("Within 1 ms for good 20.0 s after the cold start"));
  EXPECT_THAT(text, HasSubstr("Mostly constant, 1.00 ms in a host"));
  EXPECT_THAT(text, HasSubstr("Without its master a host is 1.00 ms off after 60 s"));
  EXPECT_THAT(text, HasSubstr("3 seeds say little about other worlds"));
  EXPECT_THAT(text, Not(HasSubstr("oracle")));
}

TEST(ClockAnswer, CausesAreFromOneValueToAnother) {
  evaluation::ClockResults results = sample_clock_results();
  results.causes = {.seeds = 2, .tried = {"the step of a clock", "noise"}};
  EXPECT_THAT(whole_text(clock_answer(results)),
              HasSubstr("Nothing alone, by 20 % or more: the step of a clock, noise."));
  results.causes.found = {{.what = "the step of a clock",
                           .spread_from_ms = 2,
                           .spread_to_ms = 1.5,
                           .largest_from_ms = 140000,
                           .largest_to_ms = 0.01}};
  const std::string text = whole_text(clock_answer(results));
  EXPECT_THAT(clock_answer(results).lead,
              HasSubstr("Without the step of a clock: largest error of a host from 140 s "
                        "to 10.0 us."));
  EXPECT_THAT(text, HasSubstr("No other one alone by 20 % or more. (Means over 2 seeds.)"));
  results.causes.found[0].largest_to_ms = 70'000;
  EXPECT_THAT(whole_text(clock_answer(results)),
              HasSubstr("Without the step of a clock: largest error of a host from 140 to 70.0 "
                        "s. (Means over 2 seeds.)"));
  EXPECT_THAT(text, Not(HasSubstr("Mostly constant")));
  EXPECT_THAT(text, Not(HasSubstr("Not tried")));
  results.causes.refused = {"noise: found 0, allowed more"};
  EXPECT_THAT(whole_text(clock_answer(results)),
              HasSubstr("Not tried: noise: found 0, allowed more."));
}

TEST(ClockAnswer, SaysThatClocksDoNotComeTogether) {
  evaluation::Results results = sample_clock_results().results;
  results.rows[0].below_1_ms_s = results.rows[0].below_0_01_ms_s;
  EXPECT_THAT(clock_answer_of(results), HasSubstr("No: half of the seeds or more"));
}

TEST(ClockAnswer, AnOracleIsNoAnswer) {
  evaluation::Results results = sample_clock_results().results;
  results.rows.erase(results.rows.begin());
  EXPECT_EQ(clock_answer_of(results), "No host_sync that a rig can run has a result here.");
}

}  // namespace
}  // namespace simbench::reports
