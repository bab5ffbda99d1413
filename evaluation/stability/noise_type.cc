#include "evaluation/stability/noise_type.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algorithms/ports/assert.h"
#include "evaluation/stability/compensated_sum.h"

namespace simbench::evaluation {
namespace {

constexpr double kStationary = 0.25;  // delta below it
constexpr int kMostDifferences = 2;   // which make all types stationary

constexpr const char* kNoiseIds[] = {"random_walk_fm", "flicker_fm", "white_fm", "flicker_pm",
                                     "white_pm"};

using PhasePieces = std::vector<std::vector<double>>;

PhasePieces every_mth(const TimeErrorSeries& series, std::size_t m) {
  PhasePieces pieces;
  for (const TimeErrorPiece& piece : series.pieces) {
    std::vector<double>& kept = pieces.emplace_back();
    for (std::size_t i = 0; i < piece.x_s.size(); i += m) kept.push_back(piece.x_s[i]);
  }
  return pieces;
}

void take_differences(PhasePieces& pieces) {
  for (std::vector<double>& piece : pieces) {
    for (std::size_t i = 0; i + 1 < piece.size(); ++i) piece[i] = piece[i + 1] - piece[i];
    if (!piece.empty()) piece.pop_back();
  }
}

double mean_of_pieces(const PhasePieces& pieces) {
  CompensatedSum sum;
  std::size_t count = 0;
  for (const std::vector<double>& piece : pieces) {
    for (const double z : piece) sum.add(z);
    count += piece.size();
  }
  return sum.value() / static_cast<double>(count);
}

// The correlation of neighbours; nothing with too few of them, or if all are equal.
std::optional<double> neighbour_correlation(const PhasePieces& pieces) {
  std::int64_t pairs = 0;
  for (const std::vector<double>& piece : pieces) {
    pairs += static_cast<std::int64_t>(std::max<std::size_t>(piece.size(), 1)) - 1;
  }
  if (pairs < kFewestNoisePairs) return std::nullopt;
  const double mean = mean_of_pieces(pieces);
  double products = 0;
  double squares = 0;
  for (const std::vector<double>& piece : pieces) {
    for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
      const double left = piece[i] - mean;
      const double right = piece[i + 1] - mean;
      products += left * right;
      squares += left * left + right * right;
    }
  }
  if (squares <= 0) return std::nullopt;
  return 2 * products / squares;
}

}  // namespace

const char* noise_id(NoiseType noise) {
  return kNoiseIds[static_cast<std::size_t>(static_cast<int>(noise) -
                                            static_cast<int>(NoiseType::kRandomWalkFm))];
}

std::optional<NoiseType> noise_type_at(const TimeErrorSeries& series, std::int64_t m) {
  SIMBENCH_ASSERT(m >= 1, "an averaging time is at least one interval");
  check_series(series);
  PhasePieces pieces = every_mth(series, static_cast<std::size_t>(m));
  for (int differences = 0;; ++differences) {
    const std::optional<double> correlation = neighbour_correlation(pieces);
    if (!correlation) return std::nullopt;
    // Minus infinity for neighbours that are always opposite.
    const double delta = *correlation / (1 + *correlation);
    if (delta < kStationary || differences == kMostDifferences) {
      const double alpha = std::clamp(2 - 2 * (delta + differences), -2.0, 2.0);
      return static_cast<NoiseType>(std::lround(alpha));
    }
    take_differences(pieces);
  }
}

std::vector<std::optional<NoiseType>> noise_types_over_octaves(const TimeErrorSeries& series,
                                                               std::size_t octaves) {
  std::vector<std::optional<NoiseType>> types;
  for (std::int64_t m = 1; types.size() < octaves; m *= 2) {
    std::optional<NoiseType> type = noise_type_at(series, m);
    if (!type && !types.empty()) type = types.back();
    types.push_back(type);
  }
  return types;
}

}  // namespace simbench::evaluation
