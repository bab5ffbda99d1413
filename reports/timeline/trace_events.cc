#include "reports/timeline/trace_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace simbench::reports {
namespace {

constexpr Nanoseconds kShortest(1);
constexpr Nanoseconds kLongestAnswer = std::chrono::milliseconds(50);

enum class TrackKind : std::uint8_t {
  kTrigger,
  kClock,
  kSession,
  kGathering,
  kExposure,
  kUsb,
  kHostStack,
  kChannel,
};

// In the order of display.
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

std::string track_name(const TrackKey& key) {
  const char* stream = key.stream == StreamKind::kColour ? " colour" : "";
  switch (key.kind) {
    case TrackKind::kTrigger:
      return "pulses";
    case TrackKind::kClock:
      return "clock";
    case TrackKind::kSession:
      return "session";
    case TrackKind::kGathering:
      return "gathering";
    case TrackKind::kExposure:
      return fmt::format("camera{}{} exposure", key.place, stream);
    case TrackKind::kUsb:
      return fmt::format("camera{}{} usb", key.place, stream);
    case TrackKind::kHostStack:
      return fmt::format("camera{}{} host stack", key.place, stream);
    case TrackKind::kChannel:
      break;
  }
  return fmt::format("channel host{}", key.place);
}

int order_at_an_instant(TracePhase phase) {
  switch (phase) {
    case TracePhase::kArrowBegin:
      return 1;
    case TracePhase::kArrowStep:
      return 2;
    case TracePhase::kArrowEnd:
      return 3;
    default:
      return 0;
  }
}

bool has_nominal_length(TraceWhat what) {
  return what == TraceWhat::kPulse || what == TraceWhat::kSent || what == TraceWhat::kReceived;
}

std::string host_name(std::uint32_t host) {
  return fmt::format("host{}{}", host, host == 0 ? " (master)" : "");
}

TrackKey trigger_track() { return {}; }

TrackKey host_track(std::uint32_t host, TrackKind kind) {
  return {.process = host + 1, .group = 0, .place = 0, .stream = {}, .kind = kind};
}

TrackKey frame_track(const ObservedFrame& frame, TrackKind kind) {
  return {.process = frame.host + 1,
          .group = 1,
          .place = frame.camera,
          .stream = frame.stream,
          .kind = kind};
}

TrackKey channel_track(std::uint32_t host, std::uint32_t peer) {
  return {
      .process = host + 1, .group = 2, .place = peer, .stream = {}, .kind = TrackKind::kChannel};
}

// Builds the tracks of a timeline from slices, marks and arrows.
//
// A track is identified by its key; lay_out() moves overlapping slices to further tracks of the
// same name. An arrow's point is on the track of the slice that it touches.
class TraceTracks {
 public:
  using EventIndex = std::size_t;

  // Adds a slice, of at least 1 ns.
  EventIndex slice(const TrackKey& track, TraceWhat what, std::uint32_t subject, TrueTime begin,
                   TrueTime end) {
    tracks_[track].slices.push_back(timeline_.events.size());
    return add({.at = begin,
                .length = std::max(end - begin, kShortest),
                .phase = TracePhase::kSlice,
                .what = what,
                .subject = subject});
  }

  // Adds a counter or an instant.
  void mark(const TrackKey& track, TracePhase phase, TraceWhat what, std::uint32_t subject,
            TrueTime at) {
    tracks_[track].marks.push_back(timeline_.events.size());
    add({.at = at, .length = {}, .phase = phase, .what = what, .subject = subject});
  }

  // Adds a point of an arrow on a slice, as near to `at` as the slice reaches.
  void point(TracePhase phase, TraceWhat what, std::uint64_t arrow, EventIndex slice, TrueTime at) {
    const TraceEvent& touched = timeline_.events[slice];
    points_.push_back({timeline_.events.size(), slice});
    add({.at = std::clamp(at, touched.at, touched.at + touched.length - kShortest),
         .length = {},
         .phase = phase,
         .what = what,
         .subject = touched.subject,
         .track = 0,
         .arrow = arrow});
  }

  const TraceEvent& event(EventIndex index) const { return timeline_.events[index]; }

  // Returns all in order, without the names of the processes. Call once.
  TraceTimeline lay_out() {
    for (auto& [key, base] : tracks_) lay_out(key, base);
    for (const Point& point : points_) {
      timeline_.events[point.event].track = timeline_.events[point.slice].track;
    }
    sort();
    return std::move(timeline_);
  }

 private:
  struct Point {
    EventIndex event;
    EventIndex slice;
  };
  struct BaseTrack {
    std::vector<EventIndex> slices;
    std::vector<EventIndex> marks;
  };

  EventIndex add(const TraceEvent& event) {
    timeline_.events.push_back(event);
    return timeline_.events.size() - 1;
  }

  void lay_out(const TrackKey& key, BaseTrack& base) {
    std::stable_sort(base.slices.begin(), base.slices.end(), [this](EventIndex a, EventIndex b) {
      return timeline_.events[a].at < timeline_.events[b].at;
    });
    shorten_nominal(base.slices);
    const auto first = static_cast<std::uint32_t>(timeline_.tracks.size());
    std::vector<TrueTime> free_at = {TrueTime::min()};
    for (const EventIndex index : base.slices) {
      TraceEvent& event = timeline_.events[index];
      auto lane = std::find_if(free_at.begin(), free_at.end(),
                               [&](TrueTime free) { return free <= event.at; });
      if (lane == free_at.end()) lane = free_at.insert(lane, TrueTime::min());
      *lane = event.at + event.length;
      event.track = first + static_cast<std::uint32_t>(lane - free_at.begin());
    }
    for (const EventIndex index : base.marks) timeline_.events[index].track = first;
    for (std::size_t lane = 0; lane < free_at.size(); ++lane) {
      std::string name = track_name(key);
      if (lane > 0) name += fmt::format(" ({})", lane + 1);
      timeline_.tracks.push_back({key.process, std::move(name)});
    }
  }

  // Shortens nominal lengths to the begin of the next slice.
  void shorten_nominal(const std::vector<EventIndex>& slices) {
    for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
      TraceEvent& event = timeline_.events[slices[i]];
      if (!has_nominal_length(event.what)) continue;
      const Nanoseconds free = timeline_.events[slices[i + 1]].at - event.at;
      event.length = std::clamp(free, kShortest, event.length);
    }
  }

  void sort() {
    std::stable_sort(timeline_.events.begin(), timeline_.events.end(),
                     [](const TraceEvent& a, const TraceEvent& b) {
                       return std::pair(a.at, order_at_an_instant(a.phase)) <
                              std::pair(b.at, order_at_an_instant(b.phase));
                     });
  }

  TraceTimeline timeline_;
  std::map<TrackKey, BaseTrack> tracks_;
  std::vector<Point> points_;
};

class TimelineBuilder {
 public:
  explicit TimelineBuilder(const Trace& trace) : trace_(trace) {}

  TraceTimeline build() {
    add_pulses();
    for (std::uint32_t i = 0; i < trace_.sets.size(); ++i) {
      const TraceSet& set = trace_.sets[i];
      set_slices_.push_back(tracks_.slice(host_track(0, TrackKind::kGathering), TraceWhat::kSet, i,
                                          set.begin, set.end));
    }
    for (std::uint32_t i = 0; i < trace_.frames.size(); ++i) add_frame(i);
    add_messages();
    add_clocks();
    for (std::uint32_t i = 0; i < trace_.sessions.size(); ++i) {
      const TraceSession& session = trace_.sessions[i];
      tracks_.slice(host_track(session.last.slave, TrackKind::kSession), TraceWhat::kSession, i,
                    session.at, session.end);
    }
    TraceTimeline timeline = tracks_.lay_out();
    timeline.processes.emplace_back("trigger");
    for (std::uint32_t host = 0; host < trace_.hosts; ++host) {
      timeline.processes.push_back(host_name(host));
    }
    return timeline;
  }

 private:
  using EventIndex = TraceTracks::EventIndex;

  void add_pulses() {
    for (std::uint32_t i = 0; i < trace_.pulses.size(); ++i) {
      const ObservedPulse& pulse = trace_.pulses[i];
      pulse_slices_[pulse.pulse] =
          tracks_.slice(trigger_track(), TraceWhat::kPulse, i, pulse.at, pulse.at + kShownPulse);
    }
    const TraceOptions& options = trace_.options;
    const auto start = trace_.capture_start;
    if (start && *start >= options.from && *start < options.to && *start < trace_.left_out.cut_at) {
      tracks_.mark(trigger_track(), TracePhase::kInstant, TraceWhat::kCaptureStart, 0, *start);
    }
  }

  // The pulse at the begin of a frame's arrow.
  std::optional<EventIndex> pulse_before(const ObservedFrame& way) const {
    const auto pulse = pulse_slices_.find(way.pulse);
    if (pulse == pulse_slices_.end()) return std::nullopt;
    if (tracks_.event(pulse->second).at >= way.exposure_end) return std::nullopt;
    return pulse->second;
  }

  void add_frame(std::uint32_t index) {
    const TraceFrame& frame = trace_.frames[index];
    const ObservedFrame& way = frame.way;
    const EventIndex exposure =
        tracks_.slice(frame_track(way, TrackKind::kExposure), TraceWhat::kExposure, index,
                      way.exposure_start, way.exposure_end);
    const std::optional<EventIndex> pulse = pulse_before(way);
    TrueTime exposed = way.exposure_start;
    if (pulse) {
      exposed = std::max(exposed, tracks_.event(*pulse).at);
      tracks_.point(TracePhase::kArrowBegin, TraceWhat::kFrameArrow, index + 1, *pulse,
                    tracks_.event(*pulse).at);
    }
    if (way.fate != FrameFate::kDelivered) {
      if (pulse) {
        tracks_.point(TracePhase::kArrowEnd, TraceWhat::kFrameArrow, index + 1, exposure, exposed);
      }
      return add_loss(index);
    }
    tracks_.point(pulse ? TracePhase::kArrowStep : TracePhase::kArrowBegin, TraceWhat::kFrameArrow,
                  index + 1, exposure, exposed);
    tracks_.slice(frame_track(way, TrackKind::kUsb), TraceWhat::kUsb, index, way.offered,
                  way.transferred);
    const EventIndex stack = tracks_.slice(frame_track(way, TrackKind::kHostStack),
                                           TraceWhat::kHostStack, index, way.copied, way.delivered);
    tracks_.point(frame.set ? TracePhase::kArrowStep : TracePhase::kArrowEnd,
                  TraceWhat::kFrameArrow, index + 1, stack, way.copied);
    if (!frame.set) return;
    tracks_.point(TracePhase::kArrowEnd, TraceWhat::kFrameArrow, index + 1, set_slices_[*frame.set],
                  way.delivered);
  }

  void add_loss(std::uint32_t index) {
    const ObservedFrame& way = trace_.frames[index].way;
    if (way.fate == FrameFate::kLostInCamera) {
      tracks_.mark(frame_track(way, TrackKind::kExposure), TracePhase::kInstant,
                   TraceWhat::kLostInCamera, index, way.exposure_end);
    } else if (way.fate == FrameFate::kLostOnUsb) {
      tracks_.mark(frame_track(way, TrackKind::kUsb), TracePhase::kInstant, TraceWhat::kLostOnUsb,
                   index, way.offered);
    } else {
      const bool is_lost = way.fate == FrameFate::kLostInQueue;
      tracks_.mark(frame_track(way, TrackKind::kHostStack), TracePhase::kInstant,
                   is_lost ? TraceWhat::kLostInQueue : TraceWhat::kNotPassed, index, way.delivered);
    }
  }

  struct Conversation {
    std::uint32_t last = 0;  // message
    std::optional<EventIndex> received;
    std::uint64_t arrow = 0;
  };

  void add_messages() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Conversation> links;
    for (std::uint32_t i = 0; i < trace_.messages.size(); ++i) {
      const ObservedMessage& message = trace_.messages[i];
      add_message(i, links[std::minmax(message.from, message.to)]);
    }
    for (const auto& [link, conversation] : links) end(conversation);
  }

  bool answers(const ObservedMessage& message, const Conversation& conversation) const {
    if (!conversation.received) return false;
    const ObservedMessage& before = trace_.messages[conversation.last];
    return before.to == message.from && before.arrived <= message.left &&
           message.left - before.arrived <= kLongestAnswer;
  }

  // The arrow's last point is where the last message arrived.
  void end(const Conversation& conversation) {
    if (!conversation.received) return;
    tracks_.point(TracePhase::kArrowEnd, TraceWhat::kMessageArrow, conversation.arrow,
                  *conversation.received, trace_.messages[conversation.last].arrived);
  }

  void add_message(std::uint32_t index, Conversation& conversation) {
    const ObservedMessage& message = trace_.messages[index];
    const TrackKey there = channel_track(message.from, message.to);
    const EventIndex sent =
        tracks_.slice(there, TraceWhat::kSent, index, message.left, message.left + kShownMessage);
    TracePhase phase = TracePhase::kArrowBegin;
    if (answers(message, conversation)) {
      tracks_.point(TracePhase::kArrowStep, TraceWhat::kMessageArrow, conversation.arrow,
                    *conversation.received, trace_.messages[conversation.last].arrived);
      phase = message.lost ? TracePhase::kArrowEnd : TracePhase::kArrowStep;
    } else {
      end(conversation);
      conversation.arrow = ++message_arrows_;
    }
    if (phase != TracePhase::kArrowBegin || !message.lost) {
      tracks_.point(phase, TraceWhat::kMessageArrow, conversation.arrow, sent, message.left);
    }
    conversation.last = index;
    conversation.received.reset();
    if (message.lost) {
      return tracks_.mark(there, TracePhase::kInstant, TraceWhat::kLostMessage, index,
                          message.left);
    }
    conversation.received =
        tracks_.slice(channel_track(message.to, message.from), TraceWhat::kReceived, index,
                      message.arrived, message.arrived + kShownMessage);
  }

  void add_clocks() {
    std::map<std::uint32_t, Nanoseconds> shown;
    for (std::uint32_t i = 0; i < trace_.clocks.size(); ++i) {
      const TraceClock& clock = trace_.clocks[i];
      const auto [last, is_first] = shown.try_emplace(clock.host, clock.error);
      if (!is_first && std::exchange(last->second, clock.error) == clock.error) continue;
      tracks_.mark(host_track(clock.host, TrackKind::kClock), TracePhase::kCounter,
                   TraceWhat::kClock, i, clock.at);
    }
    for (std::uint32_t i = 0; i < trace_.adjustments.size(); ++i) {
      const TraceAdjustment& adjustment = trace_.adjustments[i];
      tracks_.mark(host_track(adjustment.host, TrackKind::kClock), TracePhase::kInstant,
                   TraceWhat::kAdjustment, i, adjustment.at);
    }
  }

  const Trace& trace_;
  TraceTracks tracks_;
  std::map<std::int64_t, EventIndex> pulse_slices_;
  std::vector<EventIndex> set_slices_;
  std::uint64_t message_arrows_ = 0;
};

}  // namespace

TraceTimeline trace_timeline(const Trace& trace) { return TimelineBuilder(trace).build(); }

}  // namespace simbench::reports
