// A USB controller: how long a frame's bytes take to reach the host when cameras share the bus.
//
// Two ways of sharing:
//  - lanes: the frames of a lane's streams are transferred one after the other, in the order of
//  their
//    submission, at the whole bandwidth. A lane for each camera is a dedicated bus, one lane for
//    all streams is a FIFO bus;
//  - fair: all pending frames advance at an equal share (processor sharing).
//
// A frame is lost in two ways:
//  - dropped: its stream has `buffered_frames` transfers pending and cannot take another;
//  - incomplete: all that its lane (under fair sharing the controller) then has to transfer, the
//    frame included, would be through only after `latest`, to which its camera can hold it. It
//    takes no bandwidth.
// A controller carries what it is offered in whole frames, so of an endless overload at least
// 1 - bandwidth / offered is lost, however it is shared, and exactly that while it is never idle.
//
// The controller is a passive model; its times count from a zero of the caller's. Its owner submits
// frames and comes back at wake_up() to collect the completed transfers, all of it in order of
// time. In lanes the completion is known at submission; fair sharing revises it as frames come and
// go.
//
//   UsbController bus({.bytes_per_ns = 0.4, .is_fair = true}, 6);
//   const bool is_lost = !bus.submit(from_ms(3), 0, 460'800, 7);
//   // and at each time that wake_up() names:
//   while (const auto done = bus.take_completed(bus.wake_up())) print(*done);
//
// Complexity: O(log n) per frame, n frames pending on the controller. Source:
// docs/reference/d455.md section 3, docs/design.md section 7.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench {

struct UsbSettings {
  double bytes_per_ns = 0;
  std::uint32_t buffered_frames = 1;   // per stream
  std::uint32_t streams_per_lane = 1;  // streams i * this ... share lane i
  bool is_fair = false;                // without lanes
};

class UsbController {
 public:
  UsbController(const UsbSettings& settings, std::size_t streams);

  // Stream `stream` offers a frame of `bytes` with the number `ticket`. False: it was lost.
  bool submit(Nanoseconds now, std::size_t stream, double bytes, std::uint32_t ticket,
              Nanoseconds latest = Nanoseconds::max());

  // The common case at once: if nothing is pending and the frame, which alone takes that long,
  // completes until `latest`, whatever else is offered, it does so and this returns when. Else
  // nothing happens and this returns Nanoseconds::max(): submit() it. Until then the stream must
  // not offer another.
  Nanoseconds pass(Nanoseconds now, std::size_t stream, double transfer_ns, Nanoseconds latest) {
    if (!pending_.empty() || settings_.is_fair) return Nanoseconds::max();
    double& free_at = free_at_ns(stream);
    const double done_at_ns = queued_on(free_at, now, transfer_ns);
    const Nanoseconds done = whole(done_at_ns);
    if (done > latest) return Nanoseconds::max();
    free_at = done_at_ns;
    return done;
  }

  // When the next transfer completes if nothing else is submitted; Nanoseconds::max() if none is
  // pending.
  Nanoseconds next_completion() const;

  // When the owner must come back. Under fair sharing a new frame delays completions: there may be
  // nothing complete then.
  Nanoseconds wake_up() const { return wake_up_; }

  // At wake_up(): the ticket of a transfer that is complete, in order of completion; nothing if
  // none is left, and then wake_up() is a later date.
  std::optional<std::uint32_t> take_completed(Nanoseconds now);

 private:
  // A pending transfer. `done_at` is in ns, or under fair sharing in bytes served to
  // every pending transfer since the controller began.
  struct Transfer {
    double done_at;
    std::uint64_t order;
    std::uint32_t ticket;
    std::uint32_t stream;
  };
  static bool later(const Transfer& a, const Transfer& b);
  static Nanoseconds whole(double done_at_ns) { return from_ns_up(done_at_ns); }
  // When a frame is transferred that waits until its lane is free.
  static double queued_on(double free_at_ns, Nanoseconds now, double transfer_ns) {
    return std::max(free_at_ns, to_ns(now)) + transfer_ns;
  }
  // Under fair sharing all is one lane: when it is free does not depend on who is served first.
  double& free_at_ns(std::size_t stream) {
    return lane_free_at_ns_[settings_.is_fair ? 0 : stream / settings_.streams_per_lane];
  }
  void serve_until(Nanoseconds now);

  UsbSettings settings_;
  std::vector<Transfer> pending_;  // a min-heap by (done_at, order)
  std::vector<std::uint32_t> pending_of_stream_;
  std::uint64_t submissions_ = 0;
  std::vector<double> lane_free_at_ns_;  // when all that is pending on it is through
  double served_bytes_ = 0;              // fair: to each pending transfer
  Nanoseconds served_until_{};           // fair
  Nanoseconds wake_up_ = Nanoseconds::max();
};

}  // namespace simbench
