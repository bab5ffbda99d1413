#include "evaluation/clock_run/clock_score.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using std::chrono::seconds;
using testing::IsNan;

// The time errors at a second, in ms, the master's first.
using ErrorsMs = std::function<std::vector<double>(std::int64_t second)>;

void read_out(ClockScorer& scorer, std::int64_t last_s, const ErrorsMs& errors_ms) {
  for (std::int64_t second = 0; second <= last_s; ++second) {
    std::vector<double> errors_s = errors_ms(second);
    for (double& error : errors_s) error *= 1e-3;
    scorer.on_errors(TrueTime(seconds(second)), errors_s);
  }
}

// Scores a run of 100 s that is measured from 10 s on, with two slaves, up to `last_s`.
MetricValues<double> clock_values(std::int64_t last_s, const ErrorsMs& errors_ms) {
  ClockScorer scorer({.duration = seconds(100), .from = seconds(10), .hosts = 3});
  read_out(scorer, last_s, errors_ms);
  return scorer.finish(0).values;
}

// One slave that is ahead by so much.
MetricValues<double> clock_values_of_spread(std::int64_t last_s,
                                            const std::function<double(std::int64_t)>& spread_ms) {
  return clock_values(last_s, [&](std::int64_t second) {
    return std::vector<double>{0, spread_ms(second), 0};
  });
}

// Host 1 is 1, 2, 3, 4 ms off the master and the master 10 ms off the truth; host 2 is 1 ms off.
TEST(ClockScorer, AHostsErrorsAreAgainstTheTruthAndAgainstOneHost) {
  ClockScorer scorer({.duration = seconds(4), .from = seconds(1), .hosts = 3, .pairs_with = 2});
  for (int second = 0; second <= 4; ++second) {
    scorer.on_master(10e-3);
    scorer.on_errors(TrueTime(seconds(second)), std::vector<double>{0, second * 1e-3, 1e-3});
  }
  const ClockScore score = scorer.finish(0);
  ASSERT_EQ(score.to_truth.size(), 3U);
  EXPECT_NEAR(score.to_truth[1].median_ms, 12.5, 1e-9);
  EXPECT_NEAR(score.to_truth[1].sd_ms, std::sqrt(5.0 / 3), 1e-9) << "of a sample of four";
  EXPECT_NEAR(score.pairs[1].median_ms, 1.5, 1e-9);
  EXPECT_NEAR(score.pairs[0].median_ms, -1, 1e-9);
  EXPECT_NEAR(score.pairs[0].median_abs_ms, 1, 1e-9);
  EXPECT_EQ(score.pairs[2].p95_abs_ms, 0);
  EXPECT_EQ(score.pairs[2].sd_ms, 0);
}

TEST(ClockScorer, TheSpreadIsOfAllHostsOverTheSpanMeasured) {
  ClockScorer scorer({.duration = seconds(10), .from = seconds(4), .hosts = 3});
  read_out(scorer, 12, [](std::int64_t second) {
    if (second < 4 || second > 10) return std::vector<double>{0, 1000, -1000};
    return std::vector<double>{0, static_cast<double>(second), -0.5};
  });
  const ClockScore score = scorer.finish(37);
  const MetricValues<double>& values = score.values;
  EXPECT_DOUBLE_EQ(values.clock_spread_ms, 7.5);
  EXPECT_DOUBLE_EQ(values.clock_spread_median_ms, 7.5);
  EXPECT_DOUBLE_EQ(values.clock_spread_p95_ms, 4.5 + 0.95 * 6);
  EXPECT_DOUBLE_EQ(values.clock_spread_max_ms, 10.5);
  EXPECT_DOUBLE_EQ(values.max_te_ms, 10);
  // 4^2 + ... + 10^2 is 371.
  EXPECT_DOUBLE_EQ(values.rms_te_ms, std::sqrt((371 + 7 * 0.25) / 14));
  EXPECT_DOUBLE_EQ(values.constant_te_ms, 7);
  EXPECT_DOUBLE_EQ(values.dynamic_te_ms, 6);
  EXPECT_DOUBLE_EQ(values.packets_per_s, 3.7);
  EXPECT_EQ(score.readings.start_s, 4);
  EXPECT_EQ(score.readings.interval_s, 1);
  ASSERT_EQ(score.readings.errors_s.size(), 3U);
  EXPECT_THAT(score.readings.errors_s[1],
              testing::Pointwise(testing::DoubleEq(), {4e-3, 5e-3, 6e-3, 7e-3, 8e-3, 9e-3, 10e-3}));
}

TEST(ClockScorer, TheMasterIsOneOfTheHosts) {
  const auto values = clock_values(100, [](std::int64_t) { return std::vector<double>{0, 2, 3}; });
  EXPECT_DOUBLE_EQ(values.clock_spread_ms, 3);
}

TEST(ClockScorer, BelowABoundIsFromTheStartAndForGood) {
  const auto values = clock_values_of_spread(100, [](std::int64_t second) {
    if (second <= 2) return 5.0;
    if (second == 20) return 0.1;  // a bound is not below itself
    return second <= 7 ? 0.5 : second <= 30 ? 0.05 : 0.005;
  });
  EXPECT_DOUBLE_EQ(values.below_1_ms_s, 3);
  EXPECT_DOUBLE_EQ(values.below_0_1_ms_s, 21);
  EXPECT_DOUBLE_EQ(values.below_0_01_ms_s, 31);
}

TEST(ClockScorer, BelowFromTheStartIsZeroAndNeverIsNothing) {
  const auto values =
      clock_values_of_spread(200, [](std::int64_t second) { return second > 100 ? 10.0 : 0.05; });
  EXPECT_EQ(values.below_1_ms_s, 0) << "what is behind the duration does not count";
  EXPECT_EQ(values.below_0_1_ms_s, 0);
  EXPECT_THAT(values.below_0_01_ms_s, IsNan());
  EXPECT_THAT(
      clock_values_of_spread(100, [](std::int64_t s) { return s == 100 ? 1.0 : 0.0; }).below_1_ms_s,
      IsNan());
}

TEST(ClockScorer, HoldoverIsTheLargestErrorAtItsInstants) {
  const auto values = clock_values(4300, [](std::int64_t second) {
    const auto since_loss = static_cast<double>(std::max<std::int64_t>(second - 100, 0));
    return std::vector<double>{0, 1e-3 * since_loss, -2e-3 * since_loss};
  });
  EXPECT_NEAR(values.holdover_60_ms, 0.12, 1e-12);
  EXPECT_NEAR(values.holdover_600_ms, 1.2, 1e-12);
}

TEST(ClockScorer, WithoutALossThereIsNoHoldoverAndNoRecovery) {
  const auto values = clock_values_of_spread(100, [](std::int64_t) { return 1.0; });
  EXPECT_THAT(values.holdover_60_ms, IsNan());
  EXPECT_THAT(values.holdover_600_ms, IsNan());
  EXPECT_THAT(values.recovery_s, IsNan());
}

// The seconds of recovery of clocks that are 1 ms apart while measured, and then as stated, by
// seconds since the master's return.
double recovery_s(const std::function<double(std::int64_t)>& spread_ms) {
  return clock_values_of_spread(
             4300,
             [&](std::int64_t second) {
               return second <= 100 ? 1.0 : second < 700 ? 5.0 : spread_ms(second - 700);
             })
      .recovery_s;
}

TEST(ClockScorer, RecoveryIsTheTimeUntilTheSpreadStaysAsBefore) {
  EXPECT_EQ(recovery_s([](std::int64_t) { return 1.0; }), 0);
  EXPECT_EQ(recovery_s([](std::int64_t s) { return s < 30 ? 2.0 : 1.0; }), 30);
  EXPECT_EQ(recovery_s([](std::int64_t s) { return s == 100 ? 1.1 : 0.5; }), 101) << "relapse";
  EXPECT_EQ(recovery_s([](std::int64_t s) { return s < 3600 ? 1.1 : 1.0; }), 3600);
}

TEST(ClockScorer, WhoDoesNotRecoverHasNoRecovery) {
  EXPECT_THAT(recovery_s([](std::int64_t) { return 1.1; }), IsNan());
  EXPECT_THAT(recovery_s([](std::int64_t s) { return s == 3600 ? 1.1 : 1.0; }), IsNan());
}

TEST(ClockScorer, CurvesAreThePooledStabilityOfTheSlaves) {
  ClockScorer scorer({.duration = seconds(60), .from = seconds(10), .hosts = 3});
  const auto errors_ms = [](std::int64_t second) {
    return std::vector<double>{0, static_cast<double>(second * 7919 % 13),
                               -0.1 * static_cast<double>(second * 104729 % 17)};
  };
  read_out(scorer, 60, errors_ms);
  std::vector<Stability> slaves;
  for (const std::size_t host : {1U, 2U}) {
    TimeErrorPiece piece{.start_s = 10};
    for (std::int64_t second = 10; second <= 60; ++second) {
      piece.x_s.push_back(errors_ms(second)[host] * 1e-3);
    }
    slaves.push_back(stability_of({.interval_s = 1, .pieces = {piece}}));
  }
  const StabilityCurves curves = scorer.finish(0).curves;
  ASSERT_EQ(curves.adev.size(), slaves[0].adev.size());
  ASSERT_EQ(curves.mtie_ms.size(), slaves[0].mtie_ms.size());
  for (std::size_t i = 0; i < curves.adev.size(); ++i) {
    EXPECT_NEAR(curves.adev[i].value,
                std::hypot(slaves[0].adev[i].value, slaves[1].adev[i].value) / std::sqrt(2.0),
                1e-15);
    EXPECT_EQ(curves.adev[i].terms, 2 * slaves[0].adev[i].terms);
  }
  for (std::size_t i = 0; i < curves.mtie_ms.size(); ++i) {
    EXPECT_EQ(curves.mtie_ms[i].value,
              std::max(slaves[0].mtie_ms[i].value, slaves[1].mtie_ms[i].value));
  }
}

// A slave that gains 1 ns a second, for so long.
ClockScore score_of_hours(std::int64_t duration_s) {
  ClockScorer scorer({.duration = seconds(duration_s), .from = seconds(300), .hosts = 2});
  std::vector<double> errors_s(2);
  for (std::int64_t second = 0; second <= duration_s; ++second) {
    errors_s[1] = 1e-9 * static_cast<double>(second);
    scorer.on_errors(TrueTime(seconds(second)), errors_s);
  }
  return scorer.finish(0);
}

TEST(ClockScorer, ReadingsOfLongRunsAreThinnedAndKeepTheirTimes) {
  constexpr auto kMost = static_cast<std::int64_t>(kMostReadings);
  struct Case {
    std::int64_t readings;
    double interval_s;
  };
  for (const Case& thinned : std::vector<Case>{
           {kMost, 1}, {kMost + 1, 2}, {2 * kMost, 2}, {2 * kMost + 1, 4}, {5 * kMost, 8}}) {
    SCOPED_TRACE(thinned.readings);
    const ClockScore score = score_of_hours(300 + thinned.readings - 1);
    const ClockReadings& kept = score.readings;
    EXPECT_EQ(kept.interval_s, thinned.interval_s);
    EXPECT_EQ(kept.errors_s[1].size(),
              static_cast<std::size_t>(
                  std::ceil(static_cast<double>(thinned.readings) / thinned.interval_s)));
    for (std::size_t i = 0; i < kept.errors_s[1].size(); ++i) {
      ASSERT_NEAR(kept.errors_s[1][i],
                  1e-9 * (kept.start_s + static_cast<double>(i) * kept.interval_s), 1e-18);
    }
    double tau_s = thinned.interval_s;
    for (const StabilityPoint& point : nonempty(score.curves.mtie_ms)) {
      EXPECT_EQ(point.tau_s, tau_s);
      EXPECT_NEAR(point.value, 1e-6 * tau_s, 1e-12);
      tau_s *= 2;
    }
    EXPECT_EQ(score.curves.adev.front().tau_s, thinned.interval_s);
    // All readings count here.
    const auto last_s = static_cast<double>(299 + thinned.readings);
    EXPECT_NEAR(score.values.clock_spread_ms, 1e-6 * (300 + last_s) / 2, 1e-12);
    EXPECT_NEAR(score.values.clock_spread_median_ms, 1e-6 * (300 + last_s) / 2,
                1e-6 * thinned.interval_s);
    EXPECT_NEAR(score.values.clock_spread_max_ms, 1e-6 * last_s, 1e-15);
  }
}

TEST(PooledCurves, DeviationsAreTheRmsAndMtieTheLargest) {
  StabilityCurves a;
  StabilityCurves b;
  for (const ClockCurve& curve : clock_curves()) {
    a.*curve.points = {{.tau_s = 1, .value = 3, .terms = 10}, {.tau_s = 2, .value = 1, .terms = 8}};
    b.*curve.points = {{.tau_s = 1, .value = 4, .terms = 5}};
  }
  const std::vector<StabilityCurves> both = {b, a};
  const StabilityCurves all = pooled(both);
  for (const ClockCurve& curve : nonempty(clock_curves())) {
    SCOPED_TRACE(curve.id);
    const std::vector<StabilityPoint>& points = all.*curve.points;
    const bool is_mtie = curve.points == &StabilityCurves::mtie_ms;
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[0].tau_s, 1);
    EXPECT_DOUBLE_EQ(points[0].value, is_mtie ? 4 : std::sqrt(12.5));
    EXPECT_EQ(points[0].terms, 15);
    EXPECT_EQ(points[1].tau_s, 2);
    EXPECT_DOUBLE_EQ(points[1].value, 1) << "of those that have the tau";
    EXPECT_EQ(points[1].terms, 8);
  }
  EXPECT_TRUE(pooled({}).adev.empty());
  EXPECT_TRUE(pooled({}).mtie_ms.empty());
}

// From the end of a program on clocks run free: no value, curve or reading of it is the program's.
TEST(ClockScorer, ARunWhoseProgramEndedHasNoValues) {
  ClockScorer scorer({.duration = seconds(100), .from = seconds(10), .hosts = 3});
  read_out(scorer, 50, [](std::int64_t) { return std::vector<double>{0, 1, 2}; });
  scorer.on_program_failure({.host = 2, .program = "chronyd", .how = "exited with status 1"});
  scorer.on_outcome({.slave = 2, .synchronised = false, .message = "chronyd ended"});
  read_out(scorer, 100, [](std::int64_t) { return std::vector<double>{0, 1, 2}; });
  const ClockScore score = scorer.finish(37);
  for (const Metric& metric : metrics(ResultKind::kClockRuns)) {
    EXPECT_THAT(metric.of_seed(score.values), IsNan()) << metric.id;
  }
  EXPECT_EQ(score.program_failures.size(), 1U);
  EXPECT_EQ(score.failures.size(), 1U);
  EXPECT_EQ(score.to_truth.size(), 3U) << "each host has a place";
  EXPECT_THAT(score.to_truth[1].median_ms, IsNan());
  EXPECT_THAT(score.host_errors_ms, testing::Each(IsNan()));
  EXPECT_TRUE(score.curves.mtie_ms.empty());
  ASSERT_EQ(score.readings.errors_s.size(), 3U);
  EXPECT_TRUE(score.readings.errors_s[1].empty());
}

}  // namespace
}  // namespace simbench::evaluation
