// The evidence as facts about points of clocks, in an order in which a ClockGraph takes them.
//
// A point is the instant at which a clock counted a number. Clocks are those of the hosts, then
// those of the cameras, then those outside the rig. A fact bounds the difference of two points:
// t(to) - t(from) <= most.
//
//   a message   t(sent)   - t(received)   <= slack - least delay
//   a pulse     the same without a least delay
//   a poll      t(t0)     - t(device + 1) <= -least delay;   t(device) - t(t1) <= -least delay
//   an arrival  t(sensor) - t(arrival)    <= -(half the exposure, and the least delay)
//
// A stamp that is rounded or noisy stands for a range of the clock's counts, of which each fact
// takes the end that makes it sure. A frame has two points, the least and the most that the clock
// counted in the middle of its exposure.
//
// The order is by what the clocks count, each less a rough line of its offset, so that the points
// of a fact, and of a set, lie close together. It decides how many points are live at a time, never
// what follows from them.
//
//   void walk(const CaptureEvidence& evidence, ClockGraph& graph) {
//     const FactOrder order(evidence);
//     for (const ClockPoint& point : order.points()) graph.advance(point.clock, point.local);
//   }
//
// Complexity: O(n log n). Memory: 16 bytes a point, 24 a fact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "algorithms/certificates/rate_bound.h"
#include "evaluation/certificates/capture_evidence.h"

namespace simbench::evaluation {

struct ClockPoint {
  std::uint32_t clock = 0;
  Nanoseconds local{};
};

enum class FactKind : std::uint8_t { kMessage, kPulse, kPollRequest, kPollReply, kArrival };

struct ClockFact {
  std::uint32_t from = 0;  // places in points()
  std::uint32_t to = 0;
  Picoseconds most{};
  FactKind kind = FactKind::kMessage;
  std::uint32_t source = 0;  // its place among the evidence's messages, polls or frames

  std::uint32_t earlier() const { return from < to ? from : to; }
  std::uint32_t later() const { return from < to ? to : from; }
};

// The points of a frame.
struct FramePoints {
  std::uint32_t least = 0;
  std::uint32_t most = 0;
};

// The rates of all clocks: as assumed, or within the assumed margin of what is observed, against
// host 0's clock as time. A clock whose rate shows nowhere is as far from that as two data sheets
// say.
std::vector<RateBound> assumed_rates(const CaptureEvidence& evidence);
std::vector<RateBound> equal_rates(const CaptureEvidence& evidence, double host_ppm,
                                   double camera_ppm);

// No certificates can be made of a recording, and why.
class NotCertifiable : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws NotCertifiable for a clock whose stamps are further apart than 20 days, and for stamps
// that no clock counts: one of them is broken, and sums of picoseconds would not fit 64 bits.
class FactOrder {
 public:
  // With the rates that the evidence's assumptions say.
  explicit FactOrder(const CaptureEvidence& evidence);
  // With these, by clock.
  FactOrder(const CaptureEvidence& evidence, std::vector<RateBound> rates);

  std::size_t hosts() const { return hosts_; }
  std::size_t clocks() const { return rates_.size(); }
  const std::vector<RateBound>& rates() const { return rates_; }
  std::span<const ClockPoint> points() const { return points_; }
  std::span<const ClockFact> facts() const { return facts_; }
  const FramePoints& points_of(std::size_t frame) const { return frames_[frame]; }

  // The facts of which a point is the later end, or the earlier one, as places in facts().
  std::span<const std::uint32_t> closed_by(std::size_t point) const;
  std::span<const std::uint32_t> opened_by(std::size_t point) const;

 private:
  void add_points(const CaptureEvidence& evidence);
  void sort_points(const CaptureEvidence& evidence);
  void index_facts();
  std::uint32_t add(std::size_t clock, Nanoseconds local);
  void fact(std::uint32_t from, std::uint32_t to, Picoseconds most, FactKind kind,
            std::size_t source);

  std::size_t hosts_ = 0;
  std::vector<RateBound> rates_;
  std::vector<ClockPoint> points_;
  std::vector<ClockFact> facts_;
  std::vector<FramePoints> frames_;
  // Facts by point: those of point i from begin[i] to begin[i + 1].
  std::vector<std::uint32_t> closed_begin_, closed_;
  std::vector<std::uint32_t> opened_begin_, opened_;
};

}  // namespace simbench::evaluation
