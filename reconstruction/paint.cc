#include "reconstruction/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace simbench::reconstruction {
namespace {

// Of even steps in lightness; between them colours are mixed.
const std::array<Eigen::Vector3f, 5>& anchors() {
  static const std::array<Eigen::Vector3f, 5> colours = {
      Eigen::Vector3f(0.27F, 0.00F, 0.33F), Eigen::Vector3f(0.23F, 0.32F, 0.55F),
      Eigen::Vector3f(0.13F, 0.57F, 0.55F), Eigen::Vector3f(0.37F, 0.79F, 0.38F),
      Eigen::Vector3f(0.99F, 0.91F, 0.14F)};
  return colours;
}

}  // namespace

Eigen::Vector3f error_colour(double error_m) {
  if (std::isnan(error_m)) return Eigen::Vector3f::Constant(0.6F);
  constexpr std::size_t kSteps = 4;
  const double place = std::clamp(error_m / kPaintedUpTo, 0.0, 1.0) * kSteps;
  const std::size_t step = std::min(static_cast<std::size_t>(place), kSteps - 1);
  const auto share = static_cast<float>(place - static_cast<double>(step));
  return anchors()[step] * (1 - share) + anchors()[step + 1] * share;
}

std::vector<Eigen::Vector3f> error_colours(const VertexErrors& errors) {
  std::vector<Eigen::Vector3f> colours;
  colours.reserve(errors.matches.size());
  for (std::size_t vertex = 0; vertex < errors.matches.size(); ++vertex) {
    colours.push_back(error_colour(errors.mean_m(vertex)));
  }
  return colours;
}

}  // namespace simbench::reconstruction
