#include "reports/reconstruction/reconstruction_limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evaluation/statistics/statistics.h"

namespace simbench::reports {
namespace {

using reconstruction::CurvePoint;
using reconstruction::ReprojectionRow;

struct Point {
  double x = 0;
  double y = 0;
};
using Curve = std::vector<Point>;

// The points that have a value, by x.
Curve curve_of(const std::vector<CurvePoint>& points, double CurvePoint::*x) {
  Curve curve;
  for (const CurvePoint& point : points) {
    const double y = evaluation::median(point.mean_cm);
    if (!std::isnan(y)) curve.push_back({point.*x, y});
  }
  std::stable_sort(curve.begin(), curve.end(),
                   [](const Point& a, const Point& b) { return a.x < b.x; });
  return curve;
}

// The first point above `y`, not before `from`.
std::size_t first_above(const Curve& curve, double y, std::size_t from) {
  while (from < curve.size() && !(curve[from].y > y)) ++from;
  return from;
}

double slope_before(const Curve& curve, std::size_t end) {
  const Point& a = curve[end - 1];
  const Point& b = curve[end];
  return (b.y - a.y) / (b.x - a.x);
}

SyncLimit limit_of(const std::vector<CurvePoint>& points) {
  SyncLimit limit{.speed_m_per_s = points.front().speed_m_per_s,
                  .speed_factor = points.front().speed_factor,
                  .limit_ms = std::nullopt};
  const Curve curve = curve_of(points, &CurvePoint::desync_ms);
  if (curve.empty()) return limit;
  limit.floor_cm = curve.front().y;
  limit.last_ms = curve.back().x;
  if (curve.size() < 2) return limit;
  const double tolerated = limit.floor_cm * (1 + kToleratedGrowth);
  const std::size_t above = first_above(curve, tolerated, 1);
  const std::size_t end = std::min(above, curve.size() - 1);
  limit.cost_cm_per_ms = slope_before(curve, end);
  if (above < curve.size()) {
    limit.limit_ms = curve[end - 1].x + (tolerated - curve[end - 1].y) / limit.cost_cm_per_ms;
  }
  return limit;
}

double mean_at(const ReprojectionRow& row, std::uint64_t seed) {
  for (const reconstruction::SeedReprojection& each : row.seeds) {
    if (each.seed == seed) return each.errors.mean_cm;
  }
  return reconstruction::kNoError;
}

}  // namespace

std::vector<SyncLimit> sync_limits(const std::vector<CurvePoint>& curve) {
  std::vector<SyncLimit> limits;
  for (auto begin = curve.begin(); begin != curve.end();) {
    const auto end = std::find_if(begin, curve.end(), [&](const CurvePoint& point) {
      return point.speed_factor != begin->speed_factor;
    });
    limits.push_back(limit_of({begin, end}));
    begin = end;
  }
  return limits;
}

std::optional<PublishedRatio> published_ratio(const std::vector<ReprojectionRow>& rows) {
  const ReprojectionRow* worst = nullptr;
  const ReprojectionRow* best = nullptr;
  for (const ReprojectionRow& row : rows) {
    if (!row.published) continue;
    const double mean = row.published->mean_cm;
    if (worst == nullptr || mean > worst->published->mean_cm) worst = &row;
    if (best == nullptr || mean < best->published->mean_cm) best = &row;
  }
  if (worst == best) return std::nullopt;
  std::vector<double> ratios;
  for (const reconstruction::SeedReprojection& seed : worst->seeds) {
    ratios.push_back(seed.errors.mean_cm / mean_at(*best, seed.seed));
  }
  return PublishedRatio{.worst = worst->pipeline,
                        .best = best->pipeline,
                        .ratio = evaluation::make_series(std::move(ratios)),
                        .published = worst->published->mean_cm / best->published->mean_cm};
}

std::optional<double> speed_factor_for(const std::vector<CurvePoint>& points, double mean_cm) {
  const Curve curve = curve_of(points, &CurvePoint::speed_factor);
  if (curve.empty()) return std::nullopt;
  const std::size_t above = first_above(curve, mean_cm, 0);
  if (above == curve.size()) return std::nullopt;
  if (above == 0) return curve.front().x;
  return curve[above - 1].x + (mean_cm - curve[above - 1].y) / slope_before(curve, above);
}

}  // namespace simbench::reports
