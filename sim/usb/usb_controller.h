// A USB controller: how long a frame's bytes take to reach the host when cameras share the bus.
//
// Three ways of sharing:
//  - dedicated: every camera has the whole bandwidth to itself (a calibrated world, or one camera),
//    and transfers its frames one after the other;
//  - fifo: all frames are transferred one after the other, in the order of their submission;
//  - fair: all pending frames advance at an equal share (processor sharing).
//
// A stream that has `buffered_frames` transfers pending cannot take another: the frame is lost, as
// an incomplete frame is on an overloaded bus.
//
// The controller is a passive model on true time. Its owner submits frames and comes back at
// wake_up() to collect the completed transfers, all of it in order of time. For dedicated and fifo
// the completion is known at submission; fair sharing revises it as frames come and go.
//
//   if (!bus.submit(now, stream, bytes, frame)) lose(frame);
//   // and at each time that wake_up() names:
//   while (const auto done = bus.take_completed(now)) deliver(*done);
//
// Complexity: O(log n) per frame, n frames pending on the controller. Source:
// docs/reference/d455.md section 3, docs/design.md section 7.
#ifndef SIMBENCH_SIM_USB_USB_CONTROLLER_H_
#define SIMBENCH_SIM_USB_USB_CONTROLLER_H_

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/choices.h"

namespace simbench::sim {

using scenarios::UsbSharing;

struct UsbSettings {
  UsbSharing sharing = UsbSharing::kDedicated;
  double bytes_per_ns = 0;
  std::uint32_t buffered_frames = 1;     // per stream
  std::uint32_t streams_per_camera = 1;  // streams c * this ... belong to camera c
};

class UsbController {
 public:
  UsbController(const UsbSettings& settings, std::size_t streams);

  // Stream `stream` offers a frame of `bytes` with the number `ticket`. False: it was lost.
  bool submit(TrueTime now, std::size_t stream, double bytes, std::uint32_t ticket);

  // The common case at once: if nothing is pending and the frame, which alone takes that long,
  // completes before that, whatever else is offered, it does so and this returns when. Else nothing
  // happens and this returns TrueTime::max(): submit() it. Until then the stream must not offer
  // another.
  TrueTime pass(TrueTime now, std::size_t stream, double transfer_ns, TrueTime before) {
    if (!pending_.empty() || settings_.sharing == UsbSharing::kFair) return TrueTime::max();
    const bool is_shared = settings_.sharing == UsbSharing::kFifo;
    double& free_at_ns = lane_free_at_ns_[is_shared ? 0 : stream / settings_.streams_per_camera];
    const double done_at_ns = queued_on(free_at_ns, now, transfer_ns);
    const TrueTime done = whole(done_at_ns);
    if (done >= before) return TrueTime::max();
    free_at_ns = done_at_ns;
    return done;
  }

  // When the next transfer completes if nothing else is submitted; TrueTime::max() if none is
  // pending.
  TrueTime next_completion() const;

  // When the owner must come back. Under fair sharing a new frame delays completions: there may be
  // nothing complete then.
  TrueTime wake_up() const { return wake_up_; }

  // At wake_up(): the ticket of a transfer that is complete, in order of completion; nothing if
  // none is left, and then wake_up() is a later date.
  std::optional<std::uint32_t> take_completed(TrueTime now);

 private:
  // A pending transfer. `done_at` is in ns of true time, or under fair sharing in bytes served to
  // every pending transfer since the controller began.
  struct Transfer {
    double done_at;
    std::uint64_t order;
    std::uint32_t ticket;
    std::uint32_t stream;
  };
  static bool later(const Transfer& a, const Transfer& b);
  static TrueTime whole(double done_at_ns) { return TrueTime(from_ns_up(done_at_ns)); }
  // When a frame is transferred that waits until its lane is free.
  static double queued_on(double free_at_ns, TrueTime now, double transfer_ns) {
    const auto now_ns = static_cast<double>(now.time_since_epoch().count());
    return std::max(free_at_ns, now_ns) + transfer_ns;
  }
  double queue_on_lane(std::size_t lane, TrueTime now, double bytes) {
    return lane_free_at_ns_[lane] =
               queued_on(lane_free_at_ns_[lane], now, bytes / settings_.bytes_per_ns);
  }
  void serve_until(TrueTime now);

  UsbSettings settings_;
  std::vector<Transfer> pending_;  // a min-heap by (done_at, order)
  std::vector<std::uint32_t> pending_of_stream_;
  std::uint64_t submissions_ = 0;
  std::vector<double> lane_free_at_ns_;  // fifo: one lane; dedicated: one per camera
  double served_bytes_ = 0;              // fair: to each pending transfer
  TrueTime served_until_{};              // fair
  TrueTime wake_up_ = TrueTime::max();
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_USB_USB_CONTROLLER_H_
