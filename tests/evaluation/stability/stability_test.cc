#include "evaluation/stability/stability.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "evaluation/stability/confidence.h"
#include "tests/evaluation/stability/noises.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::DoubleNear;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Deviation kAllDeviations[] = {Deviation::kAdev, Deviation::kAdevPlain, Deviation::kMdev,
                                        Deviation::kHdev, Deviation::kHdevPlain, Deviation::kTdev,
                                        Deviation::kMtie};

TEST(Stability, GivesAllSevenDigitsOfTheNistTestSet) {
  struct Published {
    Deviation deviation;
    double values[3];  // at 1, 10 and 100 s
  };
  // NIST SP 1065, table 31.
  const Published published[] = {
      {Deviation::kAdevPlain, {2.922319e-01, 9.965736e-02, 3.897804e-02}},
      {Deviation::kAdev, {2.922319e-01, 9.159953e-02, 3.241343e-02}},
      {Deviation::kMdev, {2.922319e-01, 6.172376e-02, 2.170921e-02}},
      {Deviation::kTdev, {1.687202e-01, 3.563623e-01, 1.253382e+00}},
      {Deviation::kHdevPlain, {2.943883e-01, 1.052754e-01, 3.910861e-02}},
      {Deviation::kHdev, {2.943883e-01, 9.581083e-02, 3.237638e-02}}};
  const TimeErrorSeries series = series_of(nist_series());
  for (const Published& row : published) {
    std::int64_t m = 1;
    for (const double value : row.values) {
      const auto found = deviation_at(series, row.deviation, m);
      ASSERT_TRUE(found);
      // Half a unit of the seventh digit.
      const double unit = std::pow(10, std::floor(std::log10(value)) - 6);
      EXPECT_NEAR(found->value, value, 0.501 * unit) << static_cast<int>(row.deviation) << " " << m;
      m *= 10;
    }
  }
}

// The definitions, term by term.
struct Terms {
  double sum = 0;
  std::int64_t count = 0;
};

double second(const std::vector<double>& x, std::size_t i, std::size_t m) {
  return x[i + 2 * m] - 2 * x[i + m] + x[i];
}

Terms defined_terms(const std::vector<double>& x, Deviation deviation, std::size_t m) {
  const bool plain = deviation == Deviation::kAdevPlain || deviation == Deviation::kHdevPlain;
  const bool hadamard = deviation == Deviation::kHdev || deviation == Deviation::kHdevPlain;
  Terms terms;
  for (std::size_t i = 0; i < x.size(); i += plain ? m : 1) {
    double term = 0;
    if (deviation == Deviation::kMtie) {
      if (i + m >= x.size()) break;
      const auto [low, high] = std::minmax_element(&x[i], &x[i] + m + 1);
      terms.sum = std::max(terms.sum, *high - *low);
      ++terms.count;
      continue;
    }
    if (deviation == Deviation::kMdev || deviation == Deviation::kTdev) {
      if (i + 3 * m > x.size()) break;
      for (std::size_t j = i; j < i + m; ++j) term += second(x, j, m) / static_cast<double>(m);
    } else if (hadamard) {
      if (i + 3 * m >= x.size()) break;
      term = second(x, i + m, m) - second(x, i, m);
    } else {
      if (i + 2 * m >= x.size()) break;
      term = second(x, i, m);
    }
    terms.sum += term * term;
    ++terms.count;
  }
  return terms;
}

double defined_value(const Terms& terms, Deviation deviation, double tau_s) {
  if (deviation == Deviation::kMtie) return terms.sum;
  const bool hadamard = deviation == Deviation::kHdev || deviation == Deviation::kHdevPlain;
  const double mean = terms.sum / static_cast<double>(terms.count);
  const double value = std::sqrt(mean / (hadamard ? 6 : 2)) / tau_s;
  return deviation == Deviation::kTdev ? value * tau_s / std::sqrt(3) : value;
}

TEST(Stability, IsItsDefinitionOverRandomSeriesWithGaps) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::normal_distribution<double> normal(0, 1e-6);
    TimeErrorSeries series{.interval_s = 0.5};
    const int pieces = boost::random::uniform_int_distribution<int>(1, 3)(random);
    for (int piece = 0; piece < pieces; ++piece) {
      TimeErrorPiece& made = series.pieces.emplace_back();
      const int points = boost::random::uniform_int_distribution<int>(0, 40)(random);
      for (int i = 0; i < points; ++i) made.x_s.push_back(normal(random));
    }
    for (const Deviation deviation : kAllDeviations) {
      for (std::size_t m = 1; m < 42; ++m) {
        Terms terms;
        for (const TimeErrorPiece& piece : series.pieces) {
          const Terms of_piece = defined_terms(piece.x_s, deviation, m);
          terms.sum = deviation == Deviation::kMtie ? std::max(terms.sum, of_piece.sum)
                                                    : terms.sum + of_piece.sum;
          terms.count += of_piece.count;
        }
        const auto found = deviation_at(series, deviation, static_cast<std::int64_t>(m));
        ASSERT_EQ(found.has_value(), terms.count > 0) << "seed " << seed << ", m " << m;
        if (!found) continue;
        const double tau_s = 0.5 * static_cast<double>(m);
        EXPECT_EQ(found->tau_s, tau_s);
        EXPECT_EQ(found->terms, terms.count);
        const double value = defined_value(terms, deviation, tau_s);
        EXPECT_NEAR(found->value, value, 1e-9 * value) << "seed " << seed << ", m " << m;
      }
    }
  }
}

TEST(Stability, OctavesAreTheValuesAtPowersOfTwo) {
  TimeErrorSeries series = series_of(nist_series(), 2);
  series.pieces.push_back({.start_s = 5000, .x_s = {3, 1, 4, 1, 5}});
  for (const Deviation deviation : kAllDeviations) {
    std::int64_t m = 1;
    for (const StabilityPoint& point : nonempty(deviation_over_octaves(series, deviation))) {
      const auto single = deviation_at(series, deviation, m);
      ASSERT_TRUE(single);
      EXPECT_EQ(point.tau_s, single->tau_s);
      EXPECT_EQ(point.value, single->value);
      EXPECT_EQ(point.terms, single->terms);
      m *= 2;
    }
    EXPECT_FALSE(deviation_at(series, deviation, m)) << "the last octave is missing";
  }
}

TEST(Stability, MtieIsItsDefinitionOnAThousandSeries) {
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::normal_distribution<double> normal;
    std::vector<double> x(boost::random::uniform_int_distribution<std::size_t>(2, 130)(random));
    double walk = 0;
    for (double& value : x) value = walk += normal(random);
    const auto octaves = deviation_over_octaves(series_of(x), Deviation::kMtie);
    std::size_t m = 1;
    for (const StabilityPoint& point : nonempty(octaves)) {
      const Terms defined = defined_terms(x, Deviation::kMtie, m);
      ASSERT_EQ(point.value, defined.sum) << "seed " << seed << ", m " << m;
      ASSERT_EQ(point.terms, defined.count) << "seed " << seed << ", m " << m;
      m *= 2;
    }
    EXPECT_GE(m, x.size()) << "seed " << seed;
  }
}

TEST(Stability, NeedsTheFewestPointsThatTheHeaderStates) {
  const std::pair<Deviation, std::int64_t> fewest_at_4[] = {
      {Deviation::kAdev, 9},  {Deviation::kAdevPlain, 9},  {Deviation::kMdev, 12},
      {Deviation::kHdev, 13}, {Deviation::kHdevPlain, 13}, {Deviation::kTdev, 12},
      {Deviation::kMtie, 5}};
  for (const auto& [deviation, fewest] : fewest_at_4) {
    const auto at = [&, of = deviation](std::int64_t points) {
      return deviation_at(series_of(std::vector<double>(static_cast<std::size_t>(points), 1)), of,
                          4);
    };
    EXPECT_FALSE(at(fewest - 1));
    ASSERT_TRUE(at(fewest));
    EXPECT_EQ(at(fewest)->terms, 1);
    EXPECT_EQ(at(fewest)->value, 0);
  }
}

TEST(Stability, OfALineIsZeroAndMtieIsItsRise) {
  std::vector<double> x;
  std::vector<double> square;
  for (int i = 0; i < 100; ++i) {
    x.push_back(3 + 0.25 * i);
    square.push_back(0.5 * i * i);
  }
  const Stability stability = stability_of(series_of(x));
  for (const auto* points :
       {&stability.adev, &stability.mdev, &stability.hdev, &stability.tdev_ms}) {
    for (const StabilityPoint& point : nonempty(*points)) EXPECT_EQ(point.value, 0);
  }
  for (const StabilityPoint& point : nonempty(stability.mtie_ms)) {
    EXPECT_EQ(point.value, 250 * point.tau_s);
  }
  EXPECT_THAT(stability.steps, IsEmpty());
  // A linear drift of 1 per second: ADEV is drift tau / sqrt(2), HDEV does not see it.
  const Stability drift = stability_of(series_of(square));
  for (const StabilityPoint& point : nonempty(drift.adev)) {
    EXPECT_NEAR(point.value, point.tau_s / std::sqrt(2), 1e-12 * point.tau_s);
  }
  for (const StabilityPoint& point : nonempty(drift.hdev)) EXPECT_EQ(point.value, 0);
}

TEST(Stability, NoDifferenceReachesOverAGap) {
  // Both pieces are constant: only a difference between them would be large.
  TimeErrorSeries series{.interval_s = 1};
  series.pieces.push_back({.start_s = 0, .x_s = std::vector<double>(10, 1)});
  series.pieces.push_back({.start_s = 20, .x_s = std::vector<double>(6, 5)});
  const Stability stability = stability_of(series);
  EXPECT_EQ(stability.points, 16);
  EXPECT_EQ(stability.pieces, 2);
  ASSERT_THAT(stability.adev, SizeIs(3));
  EXPECT_EQ(stability.adev[0].terms, 8 + 4);
  EXPECT_EQ(stability.adev[1].terms, 6 + 2);
  EXPECT_EQ(stability.adev[2].terms, 2) << "the second piece is too short";
  for (const auto* points : {&stability.adev, &stability.mdev, &stability.hdev, &stability.tdev_ms,
                             &stability.mtie_ms}) {
    for (const StabilityPoint& point : nonempty(*points)) EXPECT_EQ(point.value, 0);
  }
}

TEST(Stability, OfFewPointsIsAbsent) {
  EXPECT_THAT(stability_of({}).adev, IsEmpty());
  const Stability one = stability_of(series_of({2e-3}));
  EXPECT_EQ(one.points, 1);
  EXPECT_THAT(one.adev, IsEmpty());
  EXPECT_THAT(one.mtie_ms, IsEmpty());
  EXPECT_EQ(one.time_error.max_te_ms, 2);
  const Stability two = stability_of(series_of({2e-3, -1e-3}));
  EXPECT_THAT(two.adev, IsEmpty());
  ASSERT_THAT(two.mtie_ms, SizeIs(1));
  EXPECT_DOUBLE_EQ(two.mtie_ms[0].value, 3);
  const Stability three = stability_of(series_of({0, 0, 1}));
  EXPECT_THAT(three.adev, SizeIs(1));
  EXPECT_THAT(three.mdev, SizeIs(1));
  EXPECT_THAT(three.hdev, IsEmpty());
}

TEST(Stability, AnOffsetCostsNoDigits) {
  boost::random::mt19937 random(7);
  boost::random::uniform_int_distribution<int> counts(-1000, 1000);
  std::vector<double> x;
  std::vector<double> far;
  for (int i = 0; i < 5000; ++i) {
    x.push_back(std::ldexp(counts(random), -30));  // some 1e-9 s
    far.push_back(x.back() + std::ldexp(1, 20));   // exact: days
  }
  for (const Deviation deviation : kAllDeviations) {
    const auto near_points = deviation_over_octaves(series_of(x), deviation);
    const auto far_points = deviation_over_octaves(series_of(far), deviation);
    ASSERT_EQ(near_points.size(), far_points.size());
    for (std::size_t i = 0; i < nonempty(near_points).size(); ++i) {
      EXPECT_EQ(near_points[i].value, far_points[i].value);
    }
  }
}

TEST(Stability, RollingSumsForgetWhatHasLeftThem) {
  // A huge error early on: the windows behind it are those of the quiet rest alone.
  constexpr std::size_t kSamples = 4000;
  constexpr std::size_t m = 64;
  boost::random::mt19937 random(11);
  boost::random::normal_distribution<double> normal(0, 1e-9);
  std::vector<double> x(kSamples);
  for (double& value : x) value = normal(random);
  const std::vector<double> quiet(x.begin() + 1, x.end());
  x[0] = 1e9;
  const auto loud = deviation_at(series_of(x), Deviation::kMdev, m);
  const auto rest = deviation_at(series_of(quiet), Deviation::kMdev, m);
  ASSERT_TRUE(loud && rest);
  // One window has the huge error, as 1e9 / m in its mean.
  const auto terms = static_cast<double>(loud->terms);
  EXPECT_NEAR(loud->value, 1e9 / m / std::sqrt(2 * terms) / m, 1);
  // Later windows alone: a constant with one huge outlier has no other term.
  std::vector<double> constant(kSamples, 0);
  constant[0] = 1e9 + 0.1;
  const auto outlier = deviation_at(series_of(constant), Deviation::kMdev, m);
  EXPECT_DOUBLE_EQ(outlier->value, (1e9 + 0.1) / m / std::sqrt(2 * terms) / m);
}

TEST(Stability, DeviationsHaveTheirNoiseAndItsInterval) {
  const TimeErrorSeries series = series_of(sums(white_noise(5, 1030, 1e-9)), 0.5);
  const Stability stability = stability_of(series);
  for (const ClockCurve& curve : clock_curves()) {
    std::int64_t m = 1;
    for (const StabilityPoint& point : nonempty(stability.*curve.points)) {
      if (curve.deviation == Deviation::kMtie) {
        EXPECT_FALSE(point.certainty) << "a largest value";
        continue;
      }
      ASSERT_TRUE(point.certainty) << curve.id << " " << point.tau_s;
      // From m = 32 on the type before is kept: 1030 / 32 points are too few.
      if (m <= 16) {
        EXPECT_EQ(point.certainty->noise, NoiseType::kWhiteFm) << curve.id << " " << m;
      }
      const double degrees = degrees_of_freedom(series, curve.deviation, m, point.certainty->noise);
      const Interval interval = deviation_interval(point.value, degrees);
      EXPECT_DOUBLE_EQ(point.certainty->low, interval.low);
      EXPECT_DOUBLE_EQ(point.certainty->high, interval.high);
      EXPECT_EQ(point.certainty->reliable, degrees >= 3);
      m *= 2;
    }
    if (curve.deviation == Deviation::kMtie) continue;
    EXPECT_TRUE((stability.*curve.points).front().certainty->reliable);
    EXPECT_FALSE((stability.*curve.points).back().certainty->reliable) << curve.id;
  }
  EXPECT_EQ(stability.series.pieces[0].x_s, series.pieces[0].x_s);
}

TEST(Stability, WhatTellsNoNoiseHasNoInterval) {
  for (const StabilityPoint& point : nonempty(stability_of(series_of({0, 0, 1, 0})).adev)) {
    EXPECT_FALSE(point.certainty) << "too few points";
  }
  const std::vector<double> constant(1000, 0.25);
  for (const StabilityPoint& point : nonempty(stability_of(series_of(constant)).adev)) {
    EXPECT_FALSE(point.certainty) << "a value of 0";
  }
  for (const StabilityPoint& point : nonempty(stability_curves(series_of(nist_series())).adev)) {
    EXPECT_FALSE(point.certainty);
  }
}

TEST(StabilityDeathTest, WhatIsNoNumberIsAProgrammingError) {
  EXPECT_DEATH(stability_of(series_of({0, NAN, 0})), "finite numbers");
  EXPECT_DEATH(stability_of(series_of({0, INFINITY})), "finite numbers");
  EXPECT_DEATH(stability_of(series_of({0, 1}, 0)), "positive");
  EXPECT_DEATH(deviation_at(series_of({0, 1}), Deviation::kAdev, 0), "at least one interval");
}

}  // namespace
}  // namespace simbench::evaluation
