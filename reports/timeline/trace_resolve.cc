// What a TraceRecorder works out when the run is over; the rest of it is in trace_recorder.cc.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/timeline/trace_recorder.h"

namespace simbench::reports {

// Steady clocks are read at the start of the world and with a frame every second.
TrueTime TraceRecorder::true_time(std::uint32_t host, SteadyTime at) const {
  const std::vector<Anchor>& anchors = anchors_[host];
  const auto after =
      std::find_if(anchors.begin(), anchors.end(), [&](const Anchor& a) { return a.steady > at; });
  if (after == anchors.begin()) return after->at - (after->steady - at);
  const Anchor& before = *(after - 1);
  const Nanoseconds since = at - before.steady;
  if (after == anchors.end()) return before.at + since;
  const double rate = static_cast<double>((after->at - before.at).count()) /
                      static_cast<double>((after->steady - before.steady).count());
  return before.at + Nanoseconds(std::llround(static_cast<double>(since.count()) * rate));
}

void TraceRecorder::resolve_adjustments() {
  std::erase_if(trace_.adjustments, [this](TraceAdjustment& adjustment) {
    adjustment.at = true_time(adjustment.host, adjustment.at_steady);
    const bool wanted = adjustment.at >= trace_.options.from && adjustment.at < trace_.options.to;
    if (!wanted) ++trace_.left_out.outside;
    return !wanted;
  });
}

void TraceRecorder::index_frames() {
  index_.clear();
  for (std::uint32_t i = 0; i < trace_.frames.size(); ++i) {
    const ObservedFrame& way = trace_.frames[i].way;
    if (way.fate != FrameFate::kDelivered || way.stream != scored_) continue;
    index_.push_back({{way.camera, trace_.frames[i].sensor.us}, i});
  }
  std::sort(index_.begin(), index_.end(),
            [](const Indexed& a, const Indexed& b) { return a.key < b.key; });
}

std::uint32_t* TraceRecorder::find(const FrameKey& key) {
  const auto found =
      std::lower_bound(index_.begin(), index_.end(), key,
                       [](const Indexed& indexed, const FrameKey& k) { return indexed.key < k; });
  return found != index_.end() && found->key == key ? &found->frame : nullptr;
}

// So that a set is counted with its first frame and left out with it.
void TraceRecorder::mark_leaders() {
  for (const KeptSet& set : sets_) {
    std::uint32_t* first = nullptr;
    for (const Member& member : set.members) {
      std::uint32_t* frame = find(member.key);
      if (frame != nullptr && (first == nullptr || *frame < *first)) first = frame;
    }
    if (first != nullptr) {
      trace_.frames[*first].leads_set = true;
    } else if (trace_.left_out.cut_at != TrueTime::max()) {
      ++trace_.left_out.too_many;
    } else {
      ++trace_.left_out.outside;
    }
  }
}

void TraceRecorder::resolve_stamps() {
  for (const Stamp& late : late_stamps_) {
    if (const std::uint32_t* frame = find(late.key)) trace_.frames[*frame].stamp = late.global;
  }
  for (TraceFrame& frame : trace_.frames) {
    if (frame.stamp) *frame.stamp += shift_;
  }
}

void TraceRecorder::resolve_sets() {
  for (const KeptSet& kept : sets_) {
    TraceSet set = {.frames = {},
                    .members = kept.members.size(),
                    .complete = kept.complete,
                    .range = kept.range,
                    .begin = TrueTime::max(),
                    .end = TrueTime::min()};
    for (const Member& member : kept.members) {
      const std::uint32_t* found = find(member.key);
      if (found == nullptr) continue;
      TraceFrame& frame = trace_.frames[*found];
      const TrueTime delivered = frame.way.delivered;
      frame.set = static_cast<std::uint32_t>(trace_.sets.size());
      set.frames.push_back(*found);
      set.begin = std::min(set.begin, delivered);
      set.end =
          std::max({set.end, delivered + (kept.now - member.arrival), delivered + Nanoseconds(1)});
    }
    if (!set.frames.empty()) trace_.sets.push_back(std::move(set));
  }
}

std::vector<std::string> left_out_notes(const Trace& trace) {
  std::vector<std::string> notes;
  const TraceLeftOut& left_out = trace.left_out;
  if (left_out.outside > 0) {
    notes.push_back(
        fmt::format("{} events are left out: they begin outside the window of --from-ms, --to-ms",
                    left_out.outside));
  }
  if (left_out.too_many > 0) {
    notes.push_back(fmt::format(
        "{} events are left out, all that begin {:.6f} ms after true zero or later: more than "
        "--max-events {}; raise it, or choose a window with --from-ms and --to-ms",
        left_out.too_many, to_ms(left_out.cut_at.time_since_epoch()), trace.options.max_events));
  }
  return notes;
}

}  // namespace simbench::reports
