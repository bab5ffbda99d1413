#include "algorithms/host_sync/two_way/envelope.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Whether the middle point is on or above the line from `left` to `right`.
bool is_above(const Envelope::Point& left, const Envelope::Point& middle,
              const Envelope::Point& right) {
  return (middle.y - left.y) * (right.x - left.x) >= (right.y - left.y) * (middle.x - left.x);
}

// One step of Andrew's monotone chain.
void extend(std::vector<Envelope::Point>& hull, const Envelope::Point& point) {
  if (!hull.empty() && hull.back().x == point.x) {
    if (hull.back().y <= point.y) return;
    hull.pop_back();
  }
  while (hull.size() >= 2 && is_above(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
  hull.push_back(point);
}

}  // namespace

void Envelope::add(double x, double y) {
  if (!parts_.empty()) x = std::max(x, parts_.back().hull.back().x);
  if (parts_.empty() || x - parts_.back().begin >= part_length_ ||
      parts_.back().hull.size() >= kPartVertices) {
    parts_.push_back({.begin = x, .hull = {}});
  }
  extend(parts_.back().hull, {x, y});
  const double oldest = x - part_length_ * kParts;
  while (parts_.size() > kParts + 1 || parts_.front().hull.back().x < oldest) parts_.pop_front();
  is_current_ = false;
}

void Envelope::clear() {
  parts_.clear();
  is_current_ = false;
}

double Envelope::span() const {
  return parts_.empty() ? 0 : parts_.back().hull.back().x - parts_.front().hull.front().x;
}

const std::vector<Envelope::Point>& Envelope::vertices() const {
  if (!is_current_) {
    vertices_.clear();
    for (const Part& part : parts_) {
      for (const Point& point : part.hull) extend(vertices_, point);
    }
    is_current_ = true;
  }
  return vertices_;
}

Envelope::Point Envelope::touch(double slope) const {
  SIMBENCH_ASSERT(!empty(), "an envelope without points touches nothing");
  const std::vector<Point>& hull = vertices();
  std::size_t low = 0;
  std::size_t high = hull.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const double rise = hull[middle + 1].y - hull[middle].y;
    if (rise < slope * (hull[middle + 1].x - hull[middle].x)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return hull[low];
}

std::optional<double> Envelope::at(double x) const {
  if (empty()) return std::nullopt;
  const std::vector<Point>& hull = vertices();
  if (x < hull.front().x || x > hull.back().x) return std::nullopt;
  const auto right = std::lower_bound(hull.begin(), hull.end(), x,
                                      [](const Point& point, double at) { return point.x < at; });
  if (right->x == x) return right->y;
  const auto left = right - 1;
  return left->y + (right->y - left->y) * (x - left->x) / (right->x - left->x);
}

}  // namespace simbench
