// A trace as the events of a timeline: slices on tracks, arrows between them, counters, instants.
//
// Processes: the trigger (pid 1), then the hosts in order (pid 2 is the master). Tracks are the
// threads of the Chrome trace format. Slices on a track never overlap: an overlapping one goes to a
// further track of the same name, "(2)". Per host: clock; the session of a slave, with its delays;
// gathering (shown at the master); for each stream of a camera exposure, usb (offered to the bus ->
// transferred) and host stack (copied to the kernel -> delivered); a channel for each peer, with
// the messages to and from it.
//
// Arrows: trigger pulse -> exposure -> host stack -> gathered set for each frame, as far as it got;
// along the messages of a link as long as each answers the preceding one within 50 ms.
//
// A slice lasts at least 1 ns, so that arrows can attach to it. Pulses, and messages that leave or
// arrive, have no length: they have a nominal one, or less if the next slice of the track follows
// sooner.
//
//   const TraceTimeline timeline = trace_timeline(trace);
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "reports/timeline/trace.h"

namespace simbench::reports {

inline constexpr Nanoseconds kShownPulse = std::chrono::microseconds(100);
inline constexpr Nanoseconds kShownMessage = std::chrono::microseconds(10);

enum class TracePhase : char {
  kSlice = 'X',
  kCounter = 'C',
  kInstant = 'i',
  kArrowBegin = 's',
  kArrowStep = 't',
  kArrowEnd = 'f',
};

// The kind of an event, with the list of the trace that `subject` is an index of. Points of an
// arrow have no subject.
enum class TraceWhat : std::uint8_t {
  kPulse,         // pulses
  kCaptureStart,  // none
  kExposure,      // frames
  kUsb,           // frames
  kHostStack,     // frames
  kLostInCamera,  // frames
  kLostOnUsb,     // frames
  kLostInQueue,   // frames
  kNotPassed,     // frames
  kFrameArrow,
  kSet,          // sets
  kSent,         // messages
  kReceived,     // messages
  kLostMessage,  // messages
  kMessageArrow,
  kClock,       // clocks
  kAdjustment,  // adjustments
  kSession,     // sessions
};

struct TraceEvent {
  TrueTime at{};
  Nanoseconds length{};  // of slices
  TracePhase phase = TracePhase::kSlice;
  TraceWhat what = TraceWhat::kPulse;
  std::uint32_t subject = 0;
  std::uint32_t track = 0;
  std::uint64_t arrow = 0;  // its number among the arrows of its kind
};

struct TraceTrack {
  std::uint32_t process = 0;
  std::string name;
};

struct TraceTimeline {
  std::vector<std::string> processes;  // [i] has pid i + 1
  std::vector<TraceTrack> tracks;      // by process, in the order of display; all are used
  std::vector<TraceEvent> events;      // by time; at the same instant slices before their arrows
};

TraceTimeline trace_timeline(const Trace& trace);

}  // namespace simbench::reports
