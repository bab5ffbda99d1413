#include "evaluation/scoring/time_errors.h"

#include <gmock/gmock.h>

#include <cmath>

namespace simbench::evaluation {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsNan;

TEST(TimeErrors, AreThoseOfTheirDefinition) {
  TimeErrors errors(3);
  for (const double te_ms : {1.0, -3.0, 0.5}) errors.add(1, te_ms);
  for (const double te_ms : {2.0, 2.5}) errors.add(2, te_ms);
  MetricValues<double> score;
  errors.add_to(score);
  EXPECT_DOUBLE_EQ(score.max_te_ms, 3);
  EXPECT_DOUBLE_EQ(score.rms_te_ms, std::sqrt((1 + 9 + 0.25 + 4 + 6.25) / 5));
  EXPECT_DOUBLE_EQ(score.constant_te_ms, 2.25);
  EXPECT_DOUBLE_EQ(score.dynamic_te_ms, 4);
  EXPECT_THAT(errors.means_ms(), ElementsAre(0, DoubleEq(-0.5), DoubleEq(2.25)));
}

TEST(TimeErrors, OfEachMeasureTheWorstHostCounts) {
  TimeErrors errors(3);
  for (const double te_ms : {-5.0, -5.0}) errors.add(1, te_ms);  // constant
  for (const double te_ms : {-4.0, 4.0}) errors.add(2, te_ms);   // dynamic
  MetricValues<double> score;
  errors.add_to(score);
  EXPECT_DOUBLE_EQ(score.max_te_ms, 5);
  EXPECT_DOUBLE_EQ(score.constant_te_ms, 5);
  EXPECT_DOUBLE_EQ(score.dynamic_te_ms, 8);
}

TEST(TimeErrors, OneInstantHasNoRange) {
  TimeErrors errors(2);
  errors.add(1, -0.25);
  MetricValues<double> score;
  errors.add_to(score);
  EXPECT_DOUBLE_EQ(score.max_te_ms, 0.25);
  EXPECT_DOUBLE_EQ(score.rms_te_ms, 0.25);
  EXPECT_DOUBLE_EQ(score.constant_te_ms, 0.25);
  EXPECT_DOUBLE_EQ(score.dynamic_te_ms, 0);
}

TEST(TimeErrors, DoNotExistWithoutASlaveOrAnInstant) {
  for (const std::size_t hosts : {1U, 4U}) {
    MetricValues<double> score;
    TimeErrors(hosts).add_to(score);
    EXPECT_THAT(score.max_te_ms, IsNan());
    EXPECT_THAT(score.rms_te_ms, IsNan());
    EXPECT_THAT(score.constant_te_ms, IsNan());
    EXPECT_THAT(score.dynamic_te_ms, IsNan());
  }
}

}  // namespace
}  // namespace simbench::evaluation
