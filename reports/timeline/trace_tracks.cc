#include "reports/timeline/trace_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace simbench::reports {
namespace {

constexpr Nanoseconds kShortest(1);

std::string track_name(const TrackKey& key) {
  const char* stream = key.stream == StreamKind::kColour ? " colour" : "";
  switch (key.kind) {
    case TrackKind::kTrigger:
      return "pulses";
    case TrackKind::kClock:
      return "clock";
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

}  // namespace

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

TraceTracks::EventIndex TraceTracks::slice(const TrackKey& track, TraceWhat what,
                                           std::uint32_t subject, TrueTime begin, TrueTime end) {
  tracks_[track].slices.push_back(timeline_.events.size());
  return add({.at = begin,
              .length = std::max(end - begin, kShortest),
              .phase = TracePhase::kSlice,
              .what = what,
              .subject = subject});
}

void TraceTracks::mark(const TrackKey& track, TracePhase phase, TraceWhat what,
                       std::uint32_t subject, TrueTime at) {
  tracks_[track].marks.push_back(timeline_.events.size());
  add({.at = at, .length = {}, .phase = phase, .what = what, .subject = subject});
}

TraceTracks::EventIndex TraceTracks::add(const TraceEvent& event) {
  timeline_.events.push_back(event);
  return timeline_.events.size() - 1;
}

void TraceTracks::point(TracePhase phase, TraceWhat what, std::uint64_t arrow, EventIndex slice,
                        TrueTime at) {
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

TraceTimeline TraceTracks::lay_out() {
  for (auto& [key, base] : tracks_) lay_out(key, base);
  for (const Point& point : points_) {
    timeline_.events[point.event].track = timeline_.events[point.slice].track;
  }
  sort();
  return std::move(timeline_);
}

void TraceTracks::lay_out(const TrackKey& key, BaseTrack& base) {
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

// To what is free until the next slice begins.
void TraceTracks::shorten_nominal(const std::vector<EventIndex>& slices) {
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {
    TraceEvent& event = timeline_.events[slices[i]];
    if (!has_nominal_length(event.what)) continue;
    const Nanoseconds free = timeline_.events[slices[i + 1]].at - event.at;
    event.length = std::clamp(free, kShortest, event.length);
  }
}

void TraceTracks::sort() {
  std::stable_sort(timeline_.events.begin(), timeline_.events.end(),
                   [](const TraceEvent& a, const TraceEvent& b) {
                     return std::pair(a.at, order_at_an_instant(a.phase)) <
                            std::pair(b.at, order_at_an_instant(b.phase));
                   });
}

}  // namespace simbench::reports
