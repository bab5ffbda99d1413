#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <vector>

#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "tests/algorithms/host_sync/two_way/two_way_exchanges.h"

namespace simbench {
namespace {

constexpr double kMeanMs = 0.05;

// The world of docs/reference/host_sync.md section 5, whose stamps are in steps of 100 ns.
class ExponentialWorld {
 public:
  std::vector<TwoWayExchange> exchanges(int count) {
    const ClockLine truth = remote_clock({}, 0);
    std::vector<TwoWayExchange> made;
    made.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      made.push_back(exchange_at(truth, at_second(0.01 * i), delay(), delay()));
    }
    return made;
  }

 private:
  Nanoseconds delay() {
    const Nanoseconds exact = from_ms(0.15 + tail_(engine_));
    return exact - exact % Nanoseconds(100);
  }

  boost::random::mt19937_64 engine_{5};
  boost::random::exponential_distribution<double> tail_{1 / kMeanMs};
};

template <class Estimate>
double deviation_us(int count, int runs, Estimate estimate) {
  ExponentialWorld world;
  double squares = 0;
  for (int run = 0; run < runs; ++run) {
    const RemoteReading reading = estimate(world.exchanges(count));
    const double error_us = to_ms(offset_between(reading.value, reading.at)) * 1e3;
    squares += error_us * error_us;
  }
  return std::sqrt(squares / runs);
}

class MinimaTest : public testing::TestWithParam<int> {};

TEST_P(MinimaTest, IndependentMinimaReachTheTheoreticalDeviation) {
  const int count = GetParam();
  const double theory_us = kMeanMs * 1e3 / (std::sqrt(2.0) * count);
  const double found_us = deviation_us(
      count, 2000, [](const auto& exchanges) { return independent_minima(exchanges, 0); });
  EXPECT_NEAR(found_us, theory_us, 0.1 * theory_us) << "seed 5, N = " << count;
}

INSTANTIATE_TEST_SUITE_P(Counts, MinimaTest, testing::Values(8, 64, 300));

TEST(TwoWayMinimumTest, BestRoundTripIsNearTheTabulatedDeviation) {
  const auto best = [](const auto& exchanges) { return best_round_trip(exchanges); };
  EXPECT_NEAR(deviation_us(8, 2000, best), 8.89, 0.9);
  EXPECT_NEAR(deviation_us(64, 2000, best), 2.78, 0.3);
  EXPECT_NEAR(deviation_us(300, 600, best), 1.29, 0.2);
}

TEST(TwoWayMinimumTest, WithoutJitterBothAreExactUpToHalfTheAsymmetry) {
  const ClockLine truth = remote_clock(from_ms(-40), 0);
  std::vector<TwoWayExchange> exchanges;
  exchanges.reserve(5);
  for (int i = 0; i < 5; ++i) {
    exchanges.push_back(exchange_at(truth, at_second(i), from_ms(0.3), from_ms(0.1)));
  }
  for (const RemoteReading& reading :
       {best_round_trip(exchanges), independent_minima(exchanges, 0)}) {
    EXPECT_EQ(reading.value - truth.read(reading.at), from_ms(0.1));
  }
}

TEST(TwoWayMinimumTest, TheBestRoundTripWinsWhereverItIs) {
  const ClockLine truth = remote_clock({}, 0);
  std::vector<TwoWayExchange> exchanges;
  for (int i = 0; i < 5; ++i) {
    const double late_ms = i == 3 ? 0 : 0.1 * (i + 1);
    exchanges.push_back(exchange_at(truth, at_second(i), from_ms(0.2 + late_ms), from_ms(0.2)));
  }
  EXPECT_EQ(best_round_trip(exchanges).value, truth.read(best_round_trip(exchanges).at));
}

TEST(TwoWayMinimumTest, AKnownRateIsTakenOutOfIndependentMinima) {
  const ClockLine truth = remote_clock(from_ms(3), 100'000);
  std::vector<TwoWayExchange> exchanges;
  exchanges.reserve(10);
  for (int i = 0; i < 10; ++i) {
    exchanges.push_back(exchange_at(truth, at_second(i), from_ms(0.2), from_ms(0.2)));
  }
  const RemoteReading with = independent_minima(exchanges, 100'000);
  EXPECT_NEAR(static_cast<double>((with.value - truth.read(with.at)).count()), 0, 30);
  const RemoteReading without = independent_minima(exchanges, 0);
  EXPECT_GT(truth.read(without.at) - without.value, from_ms(0.4));
}

TEST(TwoWayMinimumTest, RoundsGiveOffsetAndRate) {
  const ClockLine truth = remote_clock(from_ms(3), -25'000);
  for (const auto kind : {TwoWayMinimum::Kind::kRoundTrip, TwoWayMinimum::Kind::kIndependent}) {
    TwoWayMinimum::Settings settings;
    settings.kind = kind;
    settings.exchanges = 4;
    TwoWayMinimum estimator(settings);
    int lines = 0;
    for (int i = 0; i < 160; ++i) {
      lines += estimator.add(exchange_at(truth, at_second(0.25 * i), from_ms(0.2), from_ms(0.2)));
    }
    EXPECT_EQ(lines, 40);
    // What the first rounds did not know of the rate has not left the window yet.
    EXPECT_NEAR(estimator.line()->rate_ppb, -25'000, 100);
    const SteadyTime end = at_second(40);
    EXPECT_LT(std::abs(to_ms(estimator.line()->read(end) - truth.read(end))), 0.002);
  }
}

TEST(TwoWayMinimumTest, EarlyStopEndsARoundWithTheFirstShortExchange) {
  const ClockLine truth = remote_clock({}, 0);
  TwoWayMinimum estimator({.kind = TwoWayMinimum::Kind::kRoundTrip,
                           .exchanges = 3,
                           .early_stop = from_ms(1),
                           .estimate_rate = false});
  EXPECT_FALSE(estimator.add(exchange_at(truth, at_second(1), from_ms(0.7), from_ms(0.7))));
  EXPECT_TRUE(estimator.add(exchange_at(truth, at_second(2), from_ms(0.6), from_ms(0.3))));
  EXPECT_EQ(estimator.line()->value - truth.read(estimator.line()->at), from_ms(0.15));
  EXPECT_EQ(estimator.line()->rate_ppb, 0);
  for (int i = 3; i < 5; ++i) {
    EXPECT_FALSE(estimator.add(exchange_at(truth, at_second(i), from_ms(0.7), from_ms(0.7))));
  }
  EXPECT_TRUE(estimator.add(exchange_at(truth, at_second(5), from_ms(0.7), from_ms(0.7))));
}

TEST(TwoWayMinimumTest, AJumpOfTheRemoteClockIsFollowedAtOnceAndKeepsTheRate) {
  for (const double jump_ms : {50.0, -50.0}) {
    const ClockLine before = remote_clock({}, 10'000);
    const ClockLine after = remote_clock(from_ms(jump_ms), 10'000);
    TwoWayMinimum estimator({.exchanges = 4});
    for (int i = 0; i < 61; ++i) {
      estimator.add(exchange_at(before, at_second(0.5 * i), from_ms(0.2), from_ms(0.2)));
    }
    EXPECT_TRUE(estimator.add(exchange_at(after, at_second(31), from_ms(0.2), from_ms(0.2))));
    const Nanoseconds error = estimator.line()->read(at_second(32)) - after.read(at_second(32));
    EXPECT_LT(std::abs(to_ms(error)), 1e-3);
    EXPECT_NEAR(estimator.line()->rate_ppb, 10'000, 20);
  }
}

TEST(TwoWayMinimumTest, ImpossibleExchangesAreRefused) {
  TwoWayMinimum estimator({.kind = TwoWayMinimum::Kind::kRoundTrip, .exchanges = 1});
  TwoWayExchange exchange =
      exchange_at(remote_clock({}, 0), at_second(1), from_ms(0.2), from_ms(0.2));
  exchange.replied += from_ms(1);
  EXPECT_FALSE(estimator.add(exchange));
  EXPECT_FALSE(estimator.line());
}

}  // namespace
}  // namespace simbench
