#include "evaluation/scoring/asymmetry_floor.h"

#include <cmath>
#include <numbers>

#include "laws/normal_law.h"

namespace simbench::evaluation {
namespace {

// The mean range of 0 and n standard normals, by Simpson's rule; beyond 10 nothing is left.
double mean_range_with_zero(std::int64_t n) {
  constexpr int kSteps = 2000;
  constexpr double kEnd = 10;
  constexpr double kStep = kEnd / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double value = 1 - std::pow(normal_probability(i * kStep), static_cast<double>(n));
    const double weight = i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * value;
  }
  return 2 * sum * kStep / 3;
}

}  // namespace

std::optional<AsymmetryFloor> asymmetry_floor(double sigma_ms, std::int64_t hosts) {
  if (sigma_ms <= 0 || hosts < 2) return std::nullopt;
  const double host_sigma_ms = sigma_ms / 2;
  return AsymmetryFloor{.sigma_ms = sigma_ms,
                        .host_error_ms = host_sigma_ms * std::sqrt(2 / std::numbers::pi),
                        .amd_ms = host_sigma_ms * mean_range_with_zero(hosts - 1)};
}

}  // namespace simbench::evaluation
