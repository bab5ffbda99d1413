// Segments of a stream, and Nagle's algorithm with delayed acknowledgements between its two ends.
//
// The sender: while a segment is unacknowledged, smaller messages wait and leave together when the
// acknowledgement comes or a full segment is reached. The receiver acknowledges a second segment at
// once, a single one only after a delay, or with data of its own that leaves before.
//
// This is the algorithm alone: it decides what leaves and when an acknowledgement is due; the
// network carries both (sim/network/network.h).
//
// Source: RFC 896; RFC 1122, 4.2.3.2 and 4.2.3.4.
//
//   Nagle nagle(from_ms(40));
//   if (auto segment = nagle.add(path, id, std::move(message))) send(*segment);
//   // when a segment arrives:
//   const std::optional<TrueTime> due = nagle.on_arrival(engine.now());
//   if (!due) send_ack(nagle.acknowledge());
//   // when an acknowledgement arrives:
//   if (auto segment = nagle.on_ack()) send(*segment);
#pragma once

#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/ports/host.h"
#include "recording/true_time.h"

namespace simbench::sim {

// Numbers the paths: one per transport and direction of a link.
using PathId = std::uint32_t;

// What travels as one: a datagram, or messages of a stream that leave together.
struct Segment {
  PathId path = 0;
  MessageId first = 0;              // number of the first message
  TrueTime left{};                  // when it left the sender's stack
  TrueTime at_switch{};             // when its last bit is there
  std::int64_t switch_number = 0;   // where it is
  bool is_at_access_point = false;  // has passed the air once
  Nanoseconds sent_again_after{};   // a full buffer dropped it, on a stream
  double bytes = 0;                 // of the messages, without headers
  bool is_counted = true;           // as sent; of the copies of a group's message, one is
  boost::container::small_vector<Bytes, 1> messages{};
};

class Nagle {
 public:
  explicit Nagle(Nanoseconds ack_delay) : ack_delay_(ack_delay) {}

  // Adds a message of the sender. Returns the segment that leaves now, unless the message must
  // wait.
  std::optional<Segment> add(PathId path, MessageId id, Bytes message);
  // A segment leaves.
  void on_left() { ++sent_; }
  // The next acknowledgement arrives. Returns the waiting segment that leaves now, if any.
  std::optional<Segment> on_ack();

  // A segment reaches the receiver. Returns when its acknowledgement is due at the latest; nothing
  // if it is due at once.
  std::optional<TrueTime> on_arrival(TrueTime now);
  bool owes_ack() const { return owes_ack_; }
  bool is_ack_due(TrueTime now) const { return owes_ack_ && ack_due_ == now; }
  // The receiver acknowledges all arrived segments. Returns the acknowledgement's number.
  std::uint64_t acknowledge();
  // When an acknowledgement arrives that could arrive at `at`, as they do not overtake each other.
  TrueTime ack_in_order(TrueTime at);

 private:
  Nanoseconds ack_delay_;
  Segment waiting_;                 // for an acknowledgement
  std::uint64_t sent_ = 0;          // segments
  std::uint64_t delivered_ = 0;     // segments
  std::uint64_t acknowledged_ = 0;  // segments
  bool owes_ack_ = false;           // the receiver, for one segment
  TrueTime ack_due_{};
  std::uint64_t acks_ = 0;  // sent
  TrueTime last_ack_ = TrueTime::min();
  std::deque<std::uint64_t> acks_on_the_way_;  // each covers the segments up to this count
};

}  // namespace simbench::sim
