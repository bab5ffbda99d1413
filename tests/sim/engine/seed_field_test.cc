#include "sim/engine/seed_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "laws/normal_law.h"
#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

constexpr int kStreams = 20000;

// The first number of each stream of a run.
std::vector<double> first_numbers(const SeedField& field) {
  const SeedFieldScope scope(field);
  std::vector<double> numbers;
  for (std::uint64_t i = 0; i < kStreams; ++i) {
    numbers.push_back(RandomStream(5, "component", i).uniform());
  }
  return numbers;
}

double changed_share(const std::vector<double>& a, const std::vector<double>& b) {
  double changed = 0;
  for (int i = 0; i < kStreams; ++i) changed += a[i] != b[i] ? 1 : 0;
  return changed / kStreams;
}

// The largest distance of the distribution from the uniform one: Kolmogorov's.
double distance_from_uniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double distance = 0;
  for (int i = 0; i < kStreams; ++i) {
    distance = std::max(distance, std::abs(values[i] - (i + 0.5) / kStreams));
  }
  return distance;
}

double uniform_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double product = 0;
  for (int i = 0; i < kStreams; ++i) product += (a[i] - 0.5) * (b[i] - 0.5) * 12 / kStreams;
  return product;
}

TEST(SeedField, ChangesNothingWithoutMutations) {
  std::vector<double> plain;
  for (std::uint64_t i = 0; i < kStreams; ++i) {
    plain.push_back(RandomStream(5, "component", i).uniform());
  }
  EXPECT_EQ(first_numbers({}), plain);
}

TEST(SeedField, RenewsItsShareOfTheWords) {
  for (const double share : {0.001, 0.1, 0.5, 1.0}) {
    SeedField field;
    field.add({.key = 3, .share = share});
    const auto numbers = first_numbers(field);
    const double sigma = std::sqrt(share * (1 - share) / kStreams);
    EXPECT_NEAR(changed_share(numbers, first_numbers({})), share, 5 * sigma + 1e-9);
    // At the 1e-6 level of Kolmogorov's test: 2.69 / sqrt(n).
    EXPECT_LT(distance_from_uniform(numbers), 2.69 / std::sqrt(kStreams)) << share;
  }
}

TEST(SeedField, MovesNumbersAndKeepsTheirLaw) {
  SeedField field;
  field.add({.key = 3, .share = 1, .step = 0.3});
  const auto numbers = first_numbers(field);
  EXPECT_LT(distance_from_uniform(numbers), 2.69 / std::sqrt(kStreams));
  // The rank correlation of two normal numbers with correlation r is 6 / pi asin(r / 2).
  const double expected = 6 / std::numbers::pi * std::asin(std::sqrt(1 - 0.09) / 2);
  EXPECT_NEAR(uniform_correlation(numbers, first_numbers({})), expected, 0.02);
  // Many moves forget where they began.
  for (std::uint64_t key = 4; key < 200; ++key) field.add({.key = key, .share = 1, .step = 0.3});
  const auto later = first_numbers(field);
  EXPECT_LT(distance_from_uniform(later), 2.69 / std::sqrt(kStreams));
  EXPECT_NEAR(uniform_correlation(later, first_numbers({})), 0, 5 / std::sqrt(kStreams));
}

// A later mutation of the same stream counts, whatever the order of the streams.
TEST(SeedField, LaterMutationsCount) {
  SeedField one;
  one.add({.key = 2, .share = 1});
  SeedField both;
  both.add({.key = 1, .share = 0.5, .step = 0.5});
  both.add({.key = 2, .share = 1});
  EXPECT_EQ(first_numbers(one), first_numbers(both));
  both.add({.key = 3, .share = 0.2});
  EXPECT_NEAR(changed_share(first_numbers(one), first_numbers(both)), 0.2, 0.02);
}

TEST(SeedField, CountsOnlyWithinItsScope) {
  const double before = RandomStream(5, "component").uniform();
  {
    SeedField field;
    field.add({.key = 1});
    const SeedFieldScope scope(field);
    EXPECT_NE(RandomStream(5, "component").uniform(), before);
  }
  EXPECT_EQ(RandomStream(5, "component").uniform(), before);
}

TEST(SeedField, MovesEveryWordOfAStreamByItself) {
  SeedField field;
  field.add({.key = 9, .share = 0.3, .step = 0.1});
  std::vector<double> first;
  std::vector<double> second;
  int changed_alone = 0;
  for (std::uint64_t i = 0; i < kStreams; ++i) {
    RandomStream plain(5, "component", i);
    const double plain_first = plain.uniform();
    const double plain_second = plain.uniform();
    const SeedFieldScope scope(field);
    RandomStream stream(5, "component", i);
    first.push_back(stream.uniform());
    second.push_back(stream.uniform());
    if (first.back() == plain_first && second.back() != plain_second) ++changed_alone;
  }
  EXPECT_LT(distance_from_uniform(second), 2.69 / std::sqrt(kStreams));
  EXPECT_NEAR(uniform_correlation(first, second), 0, 5 / std::sqrt(kStreams));
  EXPECT_NEAR(static_cast<double>(changed_alone) / kStreams, 0.7 * 0.3, 0.02);
}

// By inversion, so that numbers beyond a ziggurat's tail (3.65) move as others do.
TEST(SeedField, MovesTailsByLittle) {
  constexpr double kLittle = 0.05;
  SeedField empty;
  SeedField field;
  field.add({.key = 1, .share = 1, .step = kLittle});
  std::vector<double> probabilities;
  int beyond = 0;
  for (std::uint64_t i = 0; i < 10 * kStreams; ++i) {
    const auto number = [i](const SeedField& each) {
      const SeedFieldScope scope(each);
      return RandomStream(5, "tail", i).normal(1);
    };
    const double before = number(empty);
    if (probabilities.size() < kStreams) probabilities.push_back(normal_probability(before));
    if (std::abs(before) < 3.7) continue;
    ++beyond;
    EXPECT_NEAR(number(field), before, 6 * kLittle) << i;
  }
  EXPECT_LT(distance_from_uniform(probabilities), 2.69 / std::sqrt(kStreams));
  EXPECT_NEAR(beyond, 43, 5 * std::sqrt(43.0));
}

TEST(SeedField, DrawsExponentialNumbersByInversion) {
  SeedField empty;
  const SeedFieldScope scope(empty);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const double share = RandomStream(5, "component", i).uniform();
    EXPECT_DOUBLE_EQ(RandomStream(5, "component", i).exponential(2), -2 * std::log1p(-share));
  }
}

}  // namespace
}  // namespace simbench::sim
