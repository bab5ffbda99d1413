// Degrees of freedom against exact sums, published intervals, and the coverage over many series.
#include "evaluation/stability/confidence.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/evaluation/stability/noises.h"

namespace simbench::evaluation {
namespace {

// The weights of the phase in a deviation's first term, over m: the deviation at m intervals of 1 s
// is the root of the mean square of the weighted sums, over m.
std::vector<double> weights_of(Deviation deviation, std::size_t m) {
  std::vector<double> difference(deviation == Deviation::kHdev ? 3 * m + 1 : 2 * m + 1);
  if (deviation == Deviation::kHdev) {
    difference[0] = -1, difference[m] = 3, difference[2 * m] = -3, difference[3 * m] = 1;
    for (double& weight : difference) weight /= std::sqrt(6);
    return difference;
  }
  difference[0] = 1, difference[m] = -2, difference[2 * m] = 1;
  for (double& weight : difference) weight /= std::sqrt(2);
  if (deviation == Deviation::kAdev) return difference;
  std::vector<double> mean(3 * m);
  for (std::size_t shift = 0; shift < m; ++shift) {
    for (std::size_t i = 0; i <= 2 * m; ++i) {
      mean[i + shift] += difference[i] / static_cast<double>(m);
    }
  }
  return mean;
}

// The weights of the steps where those of the phase are `weights`: a step moves all later points.
std::vector<double> of_steps(std::vector<double> weights) {
  for (std::size_t i = weights.size() - 1; i-- > 0;) weights[i] += weights[i + 1];
  return weights;
}

double square_sum(const std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight * weight;
  return sum;
}

// The weights of independent normal numbers: white phase, and its sums.
std::vector<double> weights_of(NoiseType noise, Deviation deviation, std::size_t m) {
  std::vector<double> weights = weights_of(deviation, m);
  if (noise == NoiseType::kWhitePm) return weights;
  weights = of_steps(std::move(weights));
  return noise == NoiseType::kWhiteFm ? weights : of_steps(std::move(weights));
}

// Degrees of freedom of so many terms, from the correlations of independent numbers: 2 E^2 / Var.
double exact_degrees(NoiseType noise, Deviation deviation, std::size_t m, std::size_t terms) {
  const std::vector<double> weights = weights_of(noise, deviation, m);
  const auto count = static_cast<double>(terms);
  double variance = 0;
  for (std::size_t lag = 0; lag < std::min(terms, weights.size()); ++lag) {
    double covariance = 0;
    for (std::size_t i = 0; i + lag < weights.size(); ++i) {
      covariance += weights[i] * weights[i + lag];
    }
    variance += (lag == 0 ? 1 : 2) * (count - static_cast<double>(lag)) * covariance * covariance;
  }
  const double power = square_sum(weights);
  return count * count * power * power / variance;
}

struct Case {
  NoiseType noise;
  Deviation deviation;
};
constexpr Case kCases[] = {
    {NoiseType::kWhitePm, Deviation::kAdev},      {NoiseType::kWhitePm, Deviation::kMdev},
    {NoiseType::kWhitePm, Deviation::kHdev},      {NoiseType::kWhiteFm, Deviation::kAdev},
    {NoiseType::kWhiteFm, Deviation::kMdev},      {NoiseType::kWhiteFm, Deviation::kHdev},
    {NoiseType::kRandomWalkFm, Deviation::kAdev}, {NoiseType::kRandomWalkFm, Deviation::kMdev},
    {NoiseType::kRandomWalkFm, Deviation::kHdev}};

std::int64_t terms_of(Deviation deviation, std::int64_t points, std::int64_t m) {
  return deviation == Deviation::kAdev   ? points - 2 * m
         : deviation == Deviation::kMdev ? points - 3 * m + 1
                                         : points - 3 * m;
}

TEST(DegreesOfFreedom, AreTheExactOnesOfSampledNoise) {
  // The algorithm's noise is of continuous time: that of sampled steps from some m = 16 on.
  for (const Case& of : kCases) {
    for (const std::int64_t m : {16, 30, 64, 200}) {
      for (const std::int64_t points : {700, 3000}) {
        const auto terms = static_cast<std::size_t>(terms_of(of.deviation, points, m));
        const double exact =
            exact_degrees(of.noise, of.deviation, static_cast<std::size_t>(m), terms);
        EXPECT_NEAR(degrees_of_freedom(points, of.deviation, m, of.noise), exact,
                    (m == 16 ? 0.06 : 0.04) * exact)
            << noise_id(of.noise) << ", deviation " << static_cast<int>(of.deviation) << ", m " << m
            << ", " << points << " points";
      }
    }
  }
}

TEST(DegreesOfFreedom, OfASingleTermAreOne) {
  for (const int alpha : {2, 1, 0, -1, -2}) {
    const auto noise = static_cast<NoiseType>(alpha);
    EXPECT_NEAR(degrees_of_freedom(3, Deviation::kAdev, 1, noise), 1, 1e-12);
    EXPECT_NEAR(degrees_of_freedom(201, Deviation::kAdev, 100, noise), 1, 1e-12);
    EXPECT_NEAR(degrees_of_freedom(300, Deviation::kMdev, 100, noise), 1, 1e-12);
    EXPECT_NEAR(degrees_of_freedom(301, Deviation::kHdev, 100, noise), 1, 1e-12);
    EXPECT_NEAR(degrees_of_freedom(201, Deviation::kAdevPlain, 100, noise), 1, 1e-12);
  }
}

TEST(DegreesOfFreedom, OfWhitePhaseAreThoseOfTheirSharedPoints) {
  // Neighbours at m = 1: 1 / (1 + 2 (16 + 1) / 36) of the terms, less the ends.
  EXPECT_NEAR(degrees_of_freedom(100'002, Deviation::kAdev, 1, NoiseType::kWhitePm),
              100'000.0 * 18 / 35, 2);
  EXPECT_NEAR(degrees_of_freedom(100'003, Deviation::kHdev, 1, NoiseType::kWhitePm),
              100'000.0 * 400 / 924, 2);
}

TEST(DegreesOfFreedom, OfEqualPiecesAddUp) {
  TimeErrorSeries series{.interval_s = 1};
  for (int i = 0; i < 5; ++i) series.pieces.push_back({.x_s = std::vector<double>(200)});
  const double one = degrees_of_freedom(200, Deviation::kMdev, 8, NoiseType::kWhiteFm);
  EXPECT_NEAR(degrees_of_freedom(series, Deviation::kMdev, 8, NoiseType::kWhiteFm), 5 * one, 1e-9);
  // A piece too short for a term has no part in it, one of a term as much as its weight.
  series.pieces.push_back({.x_s = std::vector<double>(23)});
  EXPECT_NEAR(degrees_of_freedom(series, Deviation::kMdev, 8, NoiseType::kWhiteFm), 5 * one, 1e-9);
  series.pieces.push_back({.x_s = std::vector<double>(24)});
  const double terms = 5 * 177;
  EXPECT_NEAR(degrees_of_freedom(series, Deviation::kMdev, 8, NoiseType::kWhiteFm),
              (terms + 1) * (terms + 1) / (terms * 177 / one + 1), 1e-9);
}

TEST(DeviationInterval, IsThatOfChiSquared) {
  // Quantiles of chi-squared with 10 degrees: 3.246973 and 20.483177.
  const Interval ten = deviation_interval(2e-9, 10);
  EXPECT_NEAR(ten.low, 2e-9 * std::sqrt(10 / 20.483177), 1e-15);
  EXPECT_NEAR(ten.high, 2e-9 * std::sqrt(10 / 3.246973), 1e-15);
  // The fewest that are reliable: 0.215795 and 9.348404.
  const Interval few = deviation_interval(1, kFewestDegrees);
  EXPECT_NEAR(few.low, std::sqrt(3 / 9.348404), 1e-6);
  EXPECT_NEAR(few.high, std::sqrt(3 / 0.215795), 1e-5);
  const Interval zero = deviation_interval(0, 5);
  EXPECT_EQ(zero.high, 0);
}

TEST(DeviationInterval, IsThePublishedOneOfTheNistSeries) {
  struct Published {
    Deviation deviation;
    std::int64_t m;
    double low;
    double high;
  };
  // Stable32 1.60 over the 1000 frequencies of NIST SP 1065, section 12.4, with a confidence of
  // 68.3 % and white frequency noise, as the tests of allantools (2017) state it.
  const Published published[] = {{Deviation::kAdev, 1, 2.8515e-01, 2.9987e-01},
                                 {Deviation::kAdev, 4, 1.3931e-01, 1.5098e-01},
                                 {Deviation::kAdev, 16, 5.7696e-02, 6.7217e-02},
                                 {Deviation::kAdev, 64, 3.1755e-02, 4.3377e-02},
                                 {Deviation::kAdev, 128, 2.3045e-02, 3.7027e-02},
                                 {Deviation::kMdev, 4, 1.0322e-01, 1.1304e-01},
                                 {Deviation::kMdev, 16, 3.8022e-02, 4.5809e-02},
                                 {Deviation::kMdev, 64, 2.3687e-02, 3.5511e-02},
                                 {Deviation::kMdev, 128, 1.4874e-02, 2.8584e-02},
                                 {Deviation::kHdev, 1, 2.8635e-01, 3.0315e-01},
                                 {Deviation::kHdev, 16, 5.6173e-02, 6.6369e-02},
                                 {Deviation::kHdev, 64, 2.9271e-02, 4.1477e-02},
                                 {Deviation::kHdev, 128, 2.3761e-02, 4.1367e-02}};
  const TimeErrorSeries series = series_of(nist_series());
  for (const Published& row : published) {
    const double value = deviation_at(series, row.deviation, row.m)->value;
    const double degrees = degrees_of_freedom(series, row.deviation, row.m, NoiseType::kWhiteFm);
    const Interval found = deviation_interval(value, degrees, 0.683);
    EXPECT_NEAR(found.low, row.low, 0.005 * row.low)
        << static_cast<int>(row.deviation) << " " << row.m;
    EXPECT_NEAR(found.high, row.high, 0.005 * row.high)
        << static_cast<int>(row.deviation) << " " << row.m;
  }
}

// How many of the series have the true deviation in their interval.
int covered(const Case& of, std::int64_t m, int series, std::size_t points) {
  const double truth =
      std::sqrt(square_sum(weights_of(of.noise, of.deviation, static_cast<std::size_t>(m)))) /
      static_cast<double>(m);
  int inside = 0;
  for (int seed = 1; seed <= series; ++seed) {
    std::vector<double> x = white_noise(static_cast<std::uint32_t>(seed), points, 1);
    if (of.noise != NoiseType::kWhitePm) x = sums(std::move(x));
    if (of.noise == NoiseType::kRandomWalkFm) x = sums(std::move(x));
    const TimeErrorSeries made = series_of(std::move(x));
    const Interval found = deviation_interval(deviation_at(made, of.deviation, m)->value,
                                              degrees_of_freedom(made, of.deviation, m, of.noise));
    inside += found.low <= truth && truth <= found.high ? 1 : 0;
  }
  return inside;
}

TEST(DeviationInterval, HoldsTheTrueDeviationIn95PercentOfSeries) {
  constexpr int kSeries = 2000;
  // Chi-squared is an approximation where terms are correlated: beside the 3.5 standard deviations
  // of a count, 1 % of all series.
  const double margin = 3.5 * std::sqrt(0.95 * 0.05 * kSeries) + 0.01 * kSeries;
  for (const Case& of : kCases) {
    for (const std::int64_t m : {4, 16, 64}) {
      EXPECT_NEAR(covered(of, m, kSeries, 300), 0.95 * kSeries, margin)
          << noise_id(of.noise) << ", deviation " << static_cast<int>(of.deviation) << ", m " << m;
    }
  }
}

TEST(ConfidenceDeathTest, MtieHasNone) {
  EXPECT_DEATH(degrees_of_freedom(100, Deviation::kMtie, 1, NoiseType::kWhitePm), "MTIE");
  EXPECT_DEATH(degrees_of_freedom(2, Deviation::kAdev, 1, NoiseType::kWhitePm), "without a term");
}

}  // namespace
}  // namespace simbench::evaluation
