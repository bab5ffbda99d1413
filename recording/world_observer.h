// An observer of a simulated world: it is notified of when everything truly happened.
//
// For timelines and figures. A recording is the same with and without an observer; times are true
// (recording/true_time.h), zero at the start of synchronisation. A frame is reported when it is
// delivered or lost, a message when it leaves, so `at`, `left` and the like of successive calls may
// go back a little.
//
// Cost without an observer: a test of a pointer per frame and message.
//
//   class Counter : public WorldObserver {
//     void on_message(const ObservedMessage&) override { ++messages; }
//     int messages = 0;
//   };
//
//   source.record({.seed = 1, .pipeline = "mine", .observer = &observer}, sink);
#pragma once

#include <cstdint>
#include <span>

#include "algorithms/ports/time.h"
#include "recording/recording.h"
#include "recording/true_time.h"

namespace simbench {

// A trigger pulse as it leaves the main trigger.
struct ObservedPulse {
  std::int64_t pulse = 0;
  TrueTime at{};
};

enum class FrameFate : std::uint8_t {
  kDelivered,
  kLostInCamera,  // never offered to the bus; nothing after exposure_end is known
  kLostOnUsb,     // refused by a full controller; nothing after `offered` is known
  kLostInQueue,   // of the program that takes the frames, at `delivered`
  kNotPassed,     // taken by a program that passes on one in so many
};

struct ObservedFrame {
  std::uint32_t camera = 0;
  std::uint32_t host = 0;
  StreamKind stream = StreamKind::kDepth;
  std::uint32_t counter = 0;
  std::int64_t pulse = -1;  // -1: free-running
  FrameFate fate = FrameFate::kDelivered;
  TrueTime exposure_start{};
  TrueTime exposure_end{};
  TrueTime offered{};      // to the USB controller: read out and ready to be sent
  TrueTime transferred{};  // the last byte is with the host
  TrueTime copied{};       // to the kernel (back-end stamp)
  TrueTime delivered{};    // to the program (time of arrival)
};

// A message between hosts. A stream's retransmissions are no messages of their own.
struct ObservedMessage {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  bool stream = false;   // TCP-like; else a datagram
  std::uint64_t id = 0;  // counts up on each direction and transport of a link
  std::size_t bytes = 0;
  TrueTime left{};
  TrueTime at_switch{};  // its last bit has come to the first switch of its way
  TrueTime arrived{};    // of no meaning if lost
  bool lost = false;     // or the stream is broken
  bool copy = false;     // of a message to several hosts: another of its copies was sent before
};

class WorldObserver {
 public:
  virtual ~WorldObserver() = default;

  // The interval of on_clocks, 0 for never; called once, at the start.
  virtual Nanoseconds clock_interval() const { return Nanoseconds(0); }

  // The world begins at `start`, with synchronisation or a service's warm-up.
  virtual void on_world(TrueTime start) = 0;
  // The cameras are started.
  virtual void on_capture_start(TrueTime at) = 0;
  virtual void on_pulse(const ObservedPulse& pulse) = 0;
  virtual void on_frame(const ObservedFrame& frame) = 0;
  virtual void on_message(const ObservedMessage& message) = 0;
  // System clock minus the master's, per host; [0] is 0.
  virtual void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) = 0;
};

}  // namespace simbench
