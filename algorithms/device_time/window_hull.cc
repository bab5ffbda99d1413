#include "algorithms/device_time/window_hull.h"

#include "algorithms/device_time/lower_hull.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Adds a point to the right of a hull.
void append(std::vector<LinePoint>& hull, LinePoint point) {
  std::size_t size = hull.size();
  while (size >= 2 && !is_vertex(hull[size - 2], hull[size - 1], point)) --size;
  hull.resize(size);
  hull.push_back(point);
}

}  // namespace

WindowHull::WindowHull(std::size_t capacity) : capacity_(capacity), older_hull_(capacity) {
  SIMBENCH_ASSERT(capacity > 0, "a window holds a point");
  older_.reserve(capacity);
  newer_.reserve(capacity);
}

void WindowHull::push(LinePoint point) {
  SIMBENCH_ASSERT(!full(), "take the oldest point out first");
  newer_.push_back(point);
  append(newer_hull_, point);
}

void WindowHull::pop() {
  SIMBENCH_ASSERT(!empty(), "no point to take out");
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
  for (const LinePoint& point : newer_hull_) append(joined_, point);
  return joined_;
}

}  // namespace simbench
