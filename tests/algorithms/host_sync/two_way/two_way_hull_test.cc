#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>

#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "tests/algorithms/host_sync/two_way/two_way_exchanges.h"

namespace simbench {
namespace {

double line_error_ns(const ClockLine& line, const ClockLine& truth, SteadyTime at) {
  return static_cast<double>((line.read(at) - truth.read(at)).count());
}

TEST(TwoWayHullTest, WithoutExchangesThereIsNoLine) {
  TwoWayHull hull({});
  EXPECT_FALSE(hull.line());
  EXPECT_FALSE(hull.width());
}

TEST(TwoWayHullTest, OneExchangeGivesTheOffset) {
  const ClockLine truth = remote_clock(from_ms(-1234.5), 0);
  TwoWayHull hull({});
  hull.add(exchange_at(truth, at_second(3), from_ms(0.2), from_ms(0.2)));
  EXPECT_NEAR(line_error_ns(*hull.line(), truth, at_second(3)), 0, 1);
  EXPECT_EQ(hull.line()->rate_ppb, 0);
}

TEST(TwoWayHullTest, WithoutJitterOffsetAndRateAreExact) {
  const ClockLine truth = remote_clock(from_ms(17), 23'456);
  TwoWayHull hull({});
  for (int i = 0; i < 100; ++i) {
    hull.add(exchange_at(truth, at_second(0.5 * i), from_ms(0.2), from_ms(0.2)));
  }
  EXPECT_NEAR(hull.line()->rate_ppb, 23'456, 0.1);
  EXPECT_NEAR(line_error_ns(*hull.line(), truth, at_second(50)), 0, 10);
  EXPECT_NEAR(static_cast<double>(hull.width()->count()), 400'000, 20);
}

// Kernel stamps on a quiet link: in a tenth of a second the clocks drift apart
// by more than a message takes, which is no jump.
TEST(TwoWayHullTest, DelaysShorterThanTheDriftSayTheRateAtOnce) {
  const ClockLine truth = remote_clock(from_ms(-300), 60'000);
  TwoWayHull hull({});
  double seconds = 0;
  for (int i = 0; i < 40; ++i) {
    hull.add(exchange_at(truth, at_second(seconds), from_ms(0.002), from_ms(0.002)));
    EXPECT_NEAR(line_error_ns(*hull.line(), truth, at_second(seconds)), 0, 6000)
        << "exchange " << i;
    seconds += i < 16 ? 0.02 : 0.25;
  }
  EXPECT_EQ(hull.resets(), 0u);
  EXPECT_NEAR(hull.line()->rate_ppb, 60'000, 1);
}

TEST(TwoWayHullTest, AsymmetryIsInTheOffsetWithItsHalfAndNotInTheRate) {
  const ClockLine truth = remote_clock(from_ms(0), -8'000);
  TwoWayHull hull({});
  for (int i = 0; i < 100; ++i) {
    hull.add(exchange_at(truth, at_second(0.5 * i), from_ms(0.3), from_ms(0.1)));
  }
  EXPECT_NEAR(line_error_ns(*hull.line(), truth, at_second(50)), 100'000, 10);
  EXPECT_NEAR(hull.line()->rate_ppb, -8'000, 0.1);
}

TEST(TwoWayHullTest, ExponentialTailsLeaveLittleAtTheEndOfTheWindow) {
  const ClockLine truth = remote_clock(from_ms(5), 31'000);
  boost::random::mt19937_64 engine(11);
  boost::random::exponential_distribution<double> tail(1 / 0.05);
  double squares = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    TwoWayHull hull({});
    for (int i = 0; i < 240; ++i) {
      hull.add(exchange_at(truth, at_second(0.25 * i), from_ms(0.15 + tail(engine)),
                           from_ms(0.15 + tail(engine))));
    }
    const double error = line_error_ns(*hull.line(), truth, at_second(60));
    squares += error * error;
    EXPECT_NEAR(hull.line()->rate_ppb, 31'000, 120) << "seed 11, run " << run;
  }
  // beta / (sqrt(2) N) = 147 ns for a known rate; the rate, at the edge of the
  // window, costs more.
  EXPECT_LT(std::sqrt(squares / kRuns), 700);
}

TEST(TwoWayHullTest, AStepOfTheRemoteClockStartsAfreshAndKeepsTheRate) {
  const ClockLine truth = remote_clock(from_ms(1), 12'000);
  TwoWayHull hull({});
  for (int i = 0; i < 100; ++i) {
    hull.add(exchange_at(truth, at_second(0.5 * i), from_ms(0.2), from_ms(0.2)));
  }
  EXPECT_EQ(hull.resets(), 0u);
  hull.line();
  for (const double step_ms : {7.0, -7.0}) {
    const ClockLine later = remote_clock(from_ms(1 + std::max(step_ms, 0.0)), 12'000);
    const double at = step_ms > 0 ? 50 : 60;
    hull.add(exchange_at(later, at_second(at), from_ms(0.2), from_ms(0.2)));
    EXPECT_NEAR(line_error_ns(*hull.line(), later, at_second(at + 1)), 0, 10);
    EXPECT_NEAR(hull.line()->rate_ppb, 12'000, 0.1);
  }
  EXPECT_EQ(hull.resets(), 2u);
}

TEST(TwoWayHullTest, RatesBeyondTheLimitAreHeldAtIt) {
  const ClockLine truth = remote_clock(from_ms(0), 90'000);
  TwoWayHull hull({.window = from_ms(60e3), .max_rate_ppm = 50});
  for (int i = 0; i < 20; ++i) {
    hull.add(exchange_at(truth, at_second(0.25 * i), from_ms(5), from_ms(5)));
  }
  EXPECT_NEAR(hull.line()->rate_ppb, 50'000, 1e-3);
}

TEST(TwoWayHullTest, ImpossibleExchangesAreRefused) {
  TwoWayHull hull({});
  TwoWayExchange exchange =
      exchange_at(remote_clock({}, 0), at_second(1), from_ms(0.2), from_ms(0.2));
  exchange.replied += from_ms(1);  // longer at the peer than away
  EXPECT_FALSE(hull.add(exchange));
  exchange = {.sent = at_second(2), .arrived = {}, .replied = {}, .received = at_second(1)};
  EXPECT_FALSE(hull.add(exchange));
  EXPECT_FALSE(hull.line());
}

TEST(TwoWayHullTest, IdenticalExchangesGiveOneFiniteLine) {
  const ClockLine truth = remote_clock(from_ms(2), 0);
  TwoWayHull hull({});
  for (int i = 0; i < 10; ++i) {
    hull.add(exchange_at(truth, at_second(1), from_ms(0.2), from_ms(0.2)));
  }
  EXPECT_NEAR(line_error_ns(*hull.line(), truth, at_second(1)), 0, 1);
  EXPECT_EQ(hull.line()->rate_ppb, 0);
}

}  // namespace
}  // namespace simbench
