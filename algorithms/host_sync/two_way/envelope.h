// The lower convex envelope of the newest points of a stream, in bounded memory.
//
// A delay can only make a stamp later, so the points (time, stamp difference) of a stream lie above
// the line they would lie on without delay; the edges of their lower convex hull are what touches
// that line from above. For an upper envelope negate y.
//
// The points of the last `window` are kept, to within one part of kParts: each part of the window
// has a hull of its own, the oldest part goes as a whole. A part that collects kPartVertices hull
// vertices ends early, so memory is at most (kParts + 1) * kPartVertices points whatever comes.
//
// Contract: x does not decrease (a smaller x is taken as the last one's); units are the caller's.
// Complexity: add() amortised O(1); the first look after an add O(vertices), usually some tens.
// Source: docs/reference/host_sync.md section 1 (two-way convex hull).
//
//   Envelope envelope(60e9);
//   envelope.add(x, y);
//   Envelope::Point touched = envelope.touch(slope);  // the vertex that the line rests on
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_ENVELOPE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_ENVELOPE_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace simbench {

class Envelope {
 public:
  struct Point {
    double x = 0;
    double y = 0;
  };
  static constexpr int kParts = 8;
  static constexpr std::size_t kPartVertices = 64;

  explicit Envelope(double window) : part_length_(window / kParts) {}

  void add(double x, double y);
  void clear();
  bool empty() const { return parts_.empty(); }
  // From the first kept point to the last.
  double span() const;

  // The vertices, in order of x, with strictly growing slopes between them.
  const std::vector<Point>& vertices() const;
  // The vertex with the smallest y - slope * x. Not for an empty envelope.
  Point touch(double slope) const;
  // The envelope at x; nothing outside of its points.
  std::optional<double> at(double x) const;

 private:
  struct Part {
    double begin = 0;
    std::vector<Point> hull;
  };

  double part_length_;
  std::deque<Part> parts_;
  mutable std::vector<Point> vertices_;
  mutable bool is_current_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_ENVELOPE_H_
