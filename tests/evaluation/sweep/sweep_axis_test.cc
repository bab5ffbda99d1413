#include <gmock/gmock.h>

#include <random>
#include <string>

#include "evaluation/sweep/sweep_plan.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> values_of(const std::string& text) {
  return parse_axis("/a/b=" + text).values.front();
}

std::string axis_problem(const std::string& text) {
  try {
    parse_axis(text);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(SweepAxis, ARangeIncludesItsStop) {
  const std::vector<std::string> values = values_of("0.1:5:0.1");
  ASSERT_EQ(values.size(), 50U);
  EXPECT_EQ(values.front(), "0.1");
  EXPECT_EQ(values[2], "0.3");
  EXPECT_EQ(values.back(), "5");
}

TEST(SweepAxis, RangesOfAllKinds) {
  EXPECT_THAT(values_of("2:6:2"), ElementsAre("2", "4", "6"));
  EXPECT_THAT(values_of("0:1:0.4"), ElementsAre("0", "0.4", "0.8"));
  EXPECT_THAT(values_of("1:-1:-1"), ElementsAre("1", "0", "-1"));
  EXPECT_THAT(values_of("7:7:1"), ElementsAre("7"));
  EXPECT_THAT(values_of("1e-3:3e-3:1e-3"), ElementsAre("0.001", "0.002", "0.003"));
  EXPECT_THAT(values_of("1e3:3e3:1e3"), ElementsAre("1000", "2000", "3000"));
  EXPECT_THAT(values_of("0:1:0.333333333333"),
              ElementsAre("0", "0.333333333333", "0.666666666666", "0.999999999999"));
}

// Any whole numbers of thousandths: value i is exactly start + i * step, as decimals have it.
TEST(SweepAxis, ValuesAreExactDecimals) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    const int start = static_cast<int>(random() % 2000) - 1000;
    const int step = static_cast<int>(random() % 500) + 1;
    const int count = static_cast<int>(random() % 40) + 1;
    const auto text = [](int thousandths) {
      char buffer[32];
      std::snprintf(buffer, sizeof buffer, "%s%d.%03d", thousandths < 0 ? "-" : "",
                    std::abs(thousandths) / 1000, std::abs(thousandths) % 1000);
      return std::string(buffer);
    };
    const std::vector<std::string> values =
        values_of(text(start) + ":" + text(start + (count - 1) * step) + ":" + text(step));
    ASSERT_EQ(values.size(), static_cast<std::size_t>(count)) << "start " << start;
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(std::stod(values[static_cast<std::size_t>(i)]), std::stod(text(start + i * step)));
      EXPECT_LE(values[static_cast<std::size_t>(i)].size(), text(start + i * step).size());
    }
  }
}

TEST(SweepAxis, Lists) {
  EXPECT_THAT(values_of("15,30.0,1e2"), ElementsAre("15", "30", "100"));
  EXPECT_THAT(values_of("true,false"), ElementsAre("true", "false"));
  EXPECT_THAT(values_of("kernel,application"), ElementsAre("kernel", "application"));
  EXPECT_THAT(values_of("9007199254740993"), ElementsAre("9007199254740993"));
}

TEST(SweepAxis, PointersInLockstep) {
  const SweepAxis axis = parse_axis("/hosts/count=2:6:2+/cameras/count=6,12,18");
  EXPECT_THAT(axis.pointers, ElementsAre("/hosts/count", "/cameras/count"));
  EXPECT_THAT(axis.values, ElementsAre(ElementsAre("2", "4", "6"), ElementsAre("6", "12", "18")));
}

TEST(SweepAxis, SaysWhatIsWrong) {
  EXPECT_THAT(axis_problem("hosts=1"), HasSubstr("found 'hosts=1', allowed: /json/pointer="));
  EXPECT_THAT(axis_problem("/a"), HasSubstr("found '/a', allowed: /json/pointer="));
  EXPECT_THAT(axis_problem("/a="), HasSubstr("found an empty value"));
  EXPECT_THAT(axis_problem("/a=1,,2"), HasSubstr("found an empty value"));
  EXPECT_THAT(axis_problem("/a=1,2,1.0"), HasSubstr("found the value 1 twice"));
  EXPECT_EQ(parse_axis("/a=1,2,3+/b=4,5,5").steps(), 3u) << "what goes along may rest";
  EXPECT_THAT(axis_problem("/a=1:2"), HasSubstr("found '1:2', allowed start:stop:step"));
  EXPECT_THAT(axis_problem("/a=1:x:2"), HasSubstr("found 'x' in a range"));
  EXPECT_THAT(axis_problem("/a=1:inf:2"), HasSubstr("found 'inf' in a range"));
  EXPECT_THAT(axis_problem("/a=1:5:0"), HasSubstr("has no end: its step is 0"));
  EXPECT_THAT(axis_problem("/a=5:1:1"), HasSubstr("is empty: from 5 steps of 1 do not lead to 1"));
  EXPECT_THAT(axis_problem("/a=0:1e9:1"), HasSubstr("allowed: at most 100000"));
  EXPECT_THAT(axis_problem("/a=[1,2]"), HasSubstr("found '[1', allowed: numbers, words"));
  EXPECT_THAT(axis_problem("/a=1,2+/b=1"),
              HasSubstr("/a has 2 values and /b has 1; in lockstep they need equally many"));
}

}  // namespace
}  // namespace simbench::evaluation
