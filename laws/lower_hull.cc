#include "laws/lower_hull.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Keeps at most half of them and the two ends, at about equal distances.
void thin(std::vector<LinePoint>& vertices) {
  const std::int64_t span = vertices.back().x - vertices.front().x;
  const std::int64_t gap = span / static_cast<std::int64_t>(LowerHull::kMaxVertices / 2);
  std::size_t kept = 1;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    if (vertices[i].x - vertices[kept - 1].x > gap) vertices[kept++] = vertices[i];
  }
  vertices[kept++] = vertices.back();
  vertices.resize(kept);
}

// Drops the vertices that a point to the right of all takes the place of: one step of Andrew's
// monotone chain.
template <class Point>
void make_way(std::vector<Point>& hull, const Point& point) {
  std::size_t size = hull.size();
  while (size >= 2 && !is_vertex(hull[size - 2], hull[size - 1], point)) --size;
  hull.resize(size);
}

// The lowest point counts if several have one x.
template <class Point>
void extend(std::vector<Point>& hull, const Point& point) {
  if (!hull.empty() && hull.back().x == point.x) {
    if (hull.back().y <= point.y) return;
    hull.pop_back();
  }
  make_way(hull, point);
  hull.push_back(point);
}

}  // namespace

void LowerHull::add(LinePoint point) {
  SIMBENCH_ASSERT(vertices_.empty() || point.x > vertices_.back().x,
                  "points of a hull come in order");
  make_way(vertices_, point);
  if (vertices_.size() == kMaxVertices) thin(vertices_);
  vertices_.push_back(point);
}

WindowHull::WindowHull(std::size_t capacity) : capacity_(capacity) {
  SIMBENCH_ASSERT(capacity > 0, "a window holds a point");
}

void WindowHull::push(LinePoint point) {
  SIMBENCH_ASSERT(!full(), "remove the oldest point first");
  newer_.push_back(point);
  extend(newer_hull_, point);
}

void WindowHull::pop() {
  SIMBENCH_ASSERT(!empty(), "no point to remove");
  if (older_.empty()) rebuild_older();
  const Older& oldest = older_.back();
  older_hull_[older_vertices_ - 1] = oldest.displaced;
  older_vertices_ = oldest.vertices_before;
  older_.pop_back();
}

void WindowHull::clear() {
  older_.clear();
  older_vertices_ = 0;
  newer_.clear();
  newer_hull_.clear();
}

void WindowHull::rebuild_older() {
  older_vertices_ = 0;
  older_hull_.resize(std::max(older_hull_.size(), newer_.size()));
  for (std::size_t i = newer_.size(); i-- > 0;) {
    const LinePoint point = newer_[i];
    std::size_t place = older_vertices_;
    while (place >= 2 && !is_vertex(point, older_hull_[place - 1], older_hull_[place - 2])) --place;
    older_.push_back({point, older_vertices_, older_hull_[place]});
    older_hull_[place] = point;
    older_vertices_ = place + 1;
  }
  newer_.clear();
  newer_hull_.clear();
}

std::span<const LinePoint> WindowHull::hull() {
  if (older_.empty()) return newer_hull_;
  joined_.clear();
  for (std::size_t i = older_vertices_; i-- > 0;) joined_.push_back(older_hull_[i]);
  for (const LinePoint& point : newer_hull_) extend(joined_, point);
  return joined_;
}

void Envelope::add(double x, double y) {
  if (!parts_.empty()) x = std::max(x, parts_.back().hull.back().x);
  if (parts_.empty() || x - parts_.back().begin >= part_length_ ||
      parts_.back().hull.size() >= kPartVertices) {
    parts_.push_back({.begin = x, .hull = {}});
  }
  extend(parts_.back().hull, Point{x, y});
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
