#include "reconstruction/reprojection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench::reconstruction {

double VertexErrors::mean_m(std::size_t vertex) const {
  if (matches[vertex] == 0) return std::numeric_limits<double>::quiet_NaN();
  return sum_m[vertex] / matches[vertex];
}

namespace {

// Colours of even steps in lightness; between them they are mixed.
const std::array<Eigen::Vector3f, 5>& anchors() {
  static const std::array<Eigen::Vector3f, 5> colours = {
      Eigen::Vector3f(0.27F, 0.00F, 0.33F), Eigen::Vector3f(0.23F, 0.32F, 0.55F),
      Eigen::Vector3f(0.13F, 0.57F, 0.55F), Eigen::Vector3f(0.37F, 0.79F, 0.38F),
      Eigen::Vector3f(0.99F, 0.91F, 0.14F)};
  return colours;
}

// The nearer of two depths; 0 is none.
float nearer(float a, float b) { return a > 0 && (b <= 0 || a < b) ? a : b; }

// Each value becomes the nearest within `reach` places before and after it in its line.
void spread_line(float* line, int length, std::ptrdiff_t step, int reach,
                 std::vector<float>& before) {
  before.resize(static_cast<std::size_t>(length));
  for (int i = 0; i < length; ++i) before[static_cast<std::size_t>(i)] = line[i * step];
  for (int i = 0; i < length; ++i) {
    float nearest = 0;
    for (int j = std::max(0, i - reach); j <= std::min(length - 1, i + reach); ++j) {
      nearest = nearer(before[static_cast<std::size_t>(j)], nearest);
    }
    line[i * step] = nearest;
  }
}

}  // namespace

DepthMap spread_to_neighbours(const DepthMap& zbuffer, int reach_px) {
  DepthMap spread = zbuffer;
  std::vector<float> before;
  for (int row = 0; row < spread.height; ++row) {
    spread_line(&spread.depth_m[spread.index(0, row)], spread.width, 1, reach_px, before);
  }
  for (int column = 0; column < spread.width; ++column) {
    spread_line(&spread.depth_m[spread.index(column, 0)], spread.height, spread.width, reach_px,
                before);
  }
  return spread;
}

void add_reprojection_errors(const TriangleMesh& mesh, const DepthMap& zbuffer,
                             const DepthMap& measured, const StudioCamera& camera,
                             const VisibilityTest& test, ErrorStatistics& errors,
                             VertexErrors& by_vertex) {
  SIMBENCH_ASSERT(zbuffer.width == measured.width && zbuffer.height == measured.height,
                  "images of one camera");
  SIMBENCH_ASSERT(by_vertex.matches.size() == mesh.vertices.size(), "one for each vertex");
  const DepthMap nearest = spread_to_neighbours(zbuffer, test.spread_px);
  const Eigen::Isometry3d camera_from_world = camera.believed.inverse();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d vertex = camera_from_world * mesh.vertices[v].cast<double>();
    if (vertex.z() <= 0) continue;
    const Eigen::Vector2d pixel = camera.intrinsics.pixel_of(vertex);
    const double column = std::round(pixel.x());
    const double row = std::round(pixel.y());
    if (!(column >= 0 && column < measured.width && row >= 0 && row < measured.height)) continue;
    const std::size_t at = measured.index(static_cast<int>(column), static_cast<int>(row));
    if (measured.depth_m[at] <= 0 || nearest.depth_m[at] <= 0) continue;
    if (vertex.z() > static_cast<double>(nearest.depth_m[at]) + test.tolerance_m) continue;
    const Eigen::Vector3d seen =
        camera.intrinsics.point_at({column, row}, static_cast<double>(measured.depth_m[at]));
    const double error = (vertex - seen).norm();
    errors.add(error);
    by_vertex.sum_m[v] += error;
    ++by_vertex.matches[v];
  }
}

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
