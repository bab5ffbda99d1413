#include "evaluation/stability/noise_type.h"

#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/evaluation/stability/noises.h"

namespace simbench::evaluation {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Eq;
using testing::IsEmpty;

constexpr NoiseType kAllTypes[] = {NoiseType::kWhitePm, NoiseType::kFlickerPm, NoiseType::kWhiteFm,
                                   NoiseType::kFlickerFm, NoiseType::kRandomWalkFm};

// Time errors of this noise.
std::vector<double> phase_of(NoiseType noise, std::uint32_t seed, std::size_t points) {
  const std::vector<double> white = white_noise(seed, points, 1e-9);
  switch (noise) {
    case NoiseType::kWhitePm:
      return white;
    case NoiseType::kFlickerPm:
      return flicker(white);
    case NoiseType::kWhiteFm:
      return sums(white);
    case NoiseType::kFlickerFm:
      return sums(flicker(white));
    default:
      return sums(sums(white));
  }
}

// The series in pieces of so many points, with a gap behind each.
TimeErrorSeries in_pieces(const std::vector<double>& x_s, std::size_t length) {
  TimeErrorSeries series{.interval_s = 1};
  for (std::size_t i = 0; i + length < x_s.size(); i += length + 3) {
    series.pieces.push_back({.start_s = static_cast<double>(i),
                             .x_s = {x_s.begin() + static_cast<std::ptrdiff_t>(i),
                                     x_s.begin() + static_cast<std::ptrdiff_t>(i + length)}});
  }
  return series;
}

int hits(NoiseType noise, std::size_t points, std::int64_t m, std::size_t piece = 0) {
  int found = 0;
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const std::vector<double> x = phase_of(noise, seed, points);
    found += noise_type_at(piece == 0 ? series_of(x) : in_pieces(x, piece), m) == noise ? 1 : 0;
  }
  return found;
}

TEST(NoiseType, EachTypeIsRecognisedInAThousandPoints) {
  for (const NoiseType noise : kAllTypes) {
    EXPECT_GE(hits(noise, 1000, 1), 49) << noise_id(noise);
    EXPECT_GE(hits(noise, 1000, 4), 35) << noise_id(noise);
  }
}

TEST(NoiseType, EachTypeIsRecognisedOverGaps) {
  for (const NoiseType noise : kAllTypes) {
    EXPECT_GE(hits(noise, 1000, 1, 40), 45) << noise_id(noise);
  }
}

TEST(NoiseType, OffsetsAndDriftAreNoNoise) {
  for (const NoiseType noise : kAllTypes) {
    std::vector<double> x = phase_of(noise, 7, 2000);
    const auto found = noise_type_at(series_of(x), 2);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto t = static_cast<double>(i);
      x[i] += 3 + 1e-6 * t;
    }
    EXPECT_EQ(noise_type_at(series_of(x), 2), found) << noise_id(noise);
  }
}

TEST(NoiseType, AMixtureChangesItsTypeWithTheAveragingTime) {
  // White phase below some m = 130, random walk of the frequency above.
  std::vector<double> x = white_noise(1, 20'000, 1);
  const std::vector<double> walk = sums(sums(white_noise(2, 20'000, 0.002)));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += walk[i];
  EXPECT_EQ(noise_type_at(series_of(x), 1), NoiseType::kWhitePm);
  EXPECT_EQ(noise_type_at(series_of(x), 512), NoiseType::kRandomWalkFm);
}

TEST(NoiseType, ASignThatAlwaysTurnsIsWhitePhase) {
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(i % 2 == 0 ? 1 : -1);
  EXPECT_EQ(noise_type_at(series_of(x), 1), NoiseType::kWhitePm);
}

TEST(NoiseType, FewPointsOrEqualOnesTellNothing) {
  EXPECT_EQ(noise_type_at({}, 1), std::nullopt);
  EXPECT_EQ(noise_type_at(series_of(std::vector<double>(1000, 0.25)), 1), std::nullopt);
  const std::vector<double> enough = white_noise(1, 31, 1);
  EXPECT_EQ(noise_type_at(series_of(enough), 1), NoiseType::kWhitePm);
  EXPECT_EQ(noise_type_at(series_of({enough.begin(), enough.end() - 1}), 1), std::nullopt);
  // Many pieces of two points have neighbours, pieces of one have none.
  EXPECT_EQ(noise_type_at(in_pieces(white_noise(1, 400, 1), 2), 1), NoiseType::kWhitePm);
  EXPECT_EQ(noise_type_at(in_pieces(white_noise(1, 400, 1), 1), 1), std::nullopt);
}

TEST(NoiseType, OctavesWithTooFewPointsHaveTheTypeBefore) {
  const auto types = noise_types_over_octaves(series_of(white_noise(1, 100, 1)), 6);
  EXPECT_THAT(types, ElementsAre(NoiseType::kWhitePm, NoiseType::kWhitePm, NoiseType::kWhitePm,
                                 NoiseType::kWhitePm, NoiseType::kWhitePm, NoiseType::kWhitePm));
  EXPECT_EQ(noise_type_at(series_of(white_noise(1, 100, 1)), 4), std::nullopt);
  EXPECT_THAT(noise_types_over_octaves(series_of({1, 2, 4}), 3), Each(Eq(std::nullopt)));
  EXPECT_THAT(noise_types_over_octaves(series_of({1, 2, 4}), 0), IsEmpty());
}

TEST(NoiseType, IdsAreThoseOfTheTypes) {
  std::vector<std::string> ids;
  for (const NoiseType noise : kAllTypes) ids.emplace_back(noise_id(noise));
  EXPECT_THAT(ids,
              ElementsAre("white_pm", "flicker_pm", "white_fm", "flicker_fm", "random_walk_fm"));
}

}  // namespace
}  // namespace simbench::evaluation
