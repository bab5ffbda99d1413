// The tracks of a timeline, made out as slices, marks and arrows are put on them.
//
// A track is known by its key; slices that would overlap go to further tracks of the same name when
// all are known. An arrow's point is on the track of the slice that it touches.
//
//   TraceTracks tracks;
//   const std::size_t pulse = tracks.slice(trigger_track(), TraceWhat::kPulse, 0, begin, end);
//   tracks.point(TracePhase::kArrowBegin, TraceWhat::kFrameArrow, 7, pulse, begin);
//   TraceTimeline timeline = tracks.lay_out();
#ifndef SIMBENCH_REPORTS_TIMELINE_TRACE_TRACKS_H_
#define SIMBENCH_REPORTS_TIMELINE_TRACE_TRACKS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "reports/timeline/trace_events.h"

namespace simbench::reports {

enum class TrackKind : std::uint8_t {
  kTrigger,
  kClock,
  kGathering,
  kExposure,
  kUsb,
  kHostStack,
  kChannel,
};

// In the order in which they are shown.
struct TrackKey {
  std::uint32_t process = 0;
  std::uint8_t group = 0;   // cameras' tracks are together, by camera
  std::uint32_t place = 0;  // camera or peer
  StreamKind stream = StreamKind::kDepth;
  TrackKind kind = TrackKind::kTrigger;
  friend bool operator<(const TrackKey& a, const TrackKey& b) {
    return std::tie(a.process, a.group, a.place, a.stream, a.kind) <
           std::tie(b.process, b.group, b.place, b.stream, b.kind);
  }
};

TrackKey trigger_track();
TrackKey host_track(std::uint32_t host, TrackKind kind);
TrackKey frame_track(const ObservedFrame& frame, TrackKind kind);
TrackKey channel_track(std::uint32_t host, std::uint32_t peer);

class TraceTracks {
 public:
  using EventIndex = std::size_t;

  // A slice lasts at least 1 ns.
  EventIndex slice(const TrackKey& track, TraceWhat what, std::uint32_t subject, TrueTime begin,
                   TrueTime end);
  // A counter or an instant.
  void mark(const TrackKey& track, TracePhase phase, TraceWhat what, std::uint32_t subject,
            TrueTime at);
  // A point of an arrow on a slice, as near to `at` as the slice goes.
  void point(TracePhase phase, TraceWhat what, std::uint64_t arrow, EventIndex slice, TrueTime at);

  const TraceEvent& event(EventIndex index) const { return timeline_.events[index]; }

  // Everything in order. Call once; the names of the processes are the caller's to add.
  TraceTimeline lay_out();

 private:
  struct Point {
    EventIndex event;
    EventIndex slice;
  };
  struct BaseTrack {
    std::vector<EventIndex> slices;
    std::vector<EventIndex> marks;
  };

  EventIndex add(const TraceEvent& event);
  void lay_out(const TrackKey& key, BaseTrack& base);
  void shorten_nominal(const std::vector<EventIndex>& slices);
  void sort();

  TraceTimeline timeline_;
  std::map<TrackKey, BaseTrack> tracks_;
  std::vector<Point> points_;
};

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_TIMELINE_TRACE_TRACKS_H_
