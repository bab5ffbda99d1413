#include "reports/timeline/trace_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "recording/counted.h"

namespace simbench::reports {
namespace {

constexpr Nanoseconds kClockInterval = std::chrono::milliseconds(50);
// Oscillators are straight enough in between.
constexpr Nanoseconds kAnchorInterval = std::chrono::seconds(1);

std::uint32_t register_of(DeviceTime sensor) {
  return static_cast<std::uint32_t>(sensor.time_since_epoch().count());  // modulo 2^32
}

}  // namespace

TraceRecorder::TraceRecorder(evaluation::PipelineScorer& scorer, StreamKind scored,
                             const TraceOptions& options)
    : ForwardingSink(scorer), scored_(scored) {
  trace_.options = options;
  scorer.watch(*this);
}

TraceRecorder::TraceRecorder(evaluation::CertifiedScoring& certified,
                             evaluation::PipelineScorer& scorer, StreamKind scored,
                             const TraceOptions& options)
    : ForwardingSink(certified), scored_(scored), certified_(&certified) {
  trace_.options = options;
  scorer.watch(*this);
}

void TraceRecorder::on_start(const RigLayout& layout) {
  trace_.hosts = layout.hosts;
  trace_.cameras = layout.cameras;
  anchors_.resize(layout.hosts);
  ForwardingSink::on_start(layout);
}

// A block has one frame, as the world is observed (RecordingRequest::observer).
void TraceRecorder::on_frames(std::span<const FrameRecord> frames,
                              std::span<const FrameTruth> truths) {
  for (std::size_t i = 0; i < frames.size(); ++i) add(frames[i], truths[i]);
  ForwardingSink::on_frames(frames, truths);
}

void TraceRecorder::add(const FrameRecord& frame, const FrameTruth& truth) {
  under_way_ = {};
  under_way_.sensor = frame.sensor;
  under_way_.reference = truth.reference;
  under_way_key_ = {frame.camera, frame.sensor.us};
  std::vector<Anchor>& anchors = anchors_[trace_.cameras[frame.camera].host];
  if (anchors.empty() || truth.mid_exposure() - anchors.back().at >= kAnchorInterval) {
    anchors.push_back({truth.own_steady, truth.mid_exposure()});
  }
}

void TraceRecorder::on_event(const RecordingEvent& event) {
  ForwardingSink::on_event(event);
  if (const auto* adjustment = std::get_if<ClockAdjustment>(&event)) add(*adjustment);
  if (const auto* delays = std::get_if<SessionDelays>(&event)) add(*delays);
}

void TraceRecorder::add(const ClockAdjustment& adjustment) {
  std::vector<Anchor>& anchors = anchors_[adjustment.host];
  if (anchors.empty()) {  // the initial setting
    anchors.push_back({adjustment.at, trace_.world_start});
    return;
  }
  if (last_seen_ >= trace_.left_out.cut_at) {
    ++trace_.left_out.too_many;
    return;
  }
  ++kept_events_;
  trace_.adjustments.push_back({.at = last_seen_,
                                .host = adjustment.host,
                                .at_steady = adjustment.at,
                                .step = adjustment.after - adjustment.before,
                                .rate_ppb = adjustment.rate_ppb});
}

void TraceRecorder::add(const SessionDelays& delays) {
  const auto open = std::ranges::find_if(trace_.sessions, [&](const TraceSession& session) {
    return session.last.slave == delays.slave && session.last.pass < delays.pass;
  });
  if (open != trace_.sessions.end()) {
    open->last = delays;
  } else if (last_seen_ >= trace_.left_out.cut_at) {
    ++trace_.left_out.too_many;
  } else {
    ++kept_events_;
    trace_.sessions.push_back(
        {.at = last_seen_, .end = {}, .begin_steady = delays.begin, .last = delays});
  }
}

Nanoseconds TraceRecorder::clock_interval() const { return kClockInterval; }

void TraceRecorder::on_world(TrueTime start) { trace_.world_start = last_seen_ = start; }

void TraceRecorder::on_capture_start(TrueTime at) { trace_.capture_start = last_seen_ = at; }

void TraceRecorder::on_pulse(const ObservedPulse& pulse) {
  last_seen_ = pulse.at;
  take(trace_.pulses, pulse);
}

void TraceRecorder::on_frame(const ObservedFrame& frame) {
  TraceFrame kept;
  if (frame.fate == FrameFate::kDelivered) {
    last_seen_ = frame.delivered;
    kept = std::exchange(under_way_, {});
    under_way_key_ = {};
  }
  kept.way = frame;
  take(trace_.frames, std::move(kept));
}

void TraceRecorder::on_message(const ObservedMessage& message) {
  last_seen_ = std::max(last_seen_, message.left);
  take(trace_.messages, message);
}

void TraceRecorder::on_clocks(TrueTime at, std::span<const Nanoseconds> errors) {
  for (std::uint32_t host = 0; host < errors.size(); ++host) {
    take(trace_.clocks, {.at = at, .host = host, .error = errors[host]});
  }
}

void TraceRecorder::on_stamp(const GatherFrame& frame) {
  const FrameKey key = {frame.source, register_of(frame.sensor)};
  if (key == under_way_key_) {
    under_way_.stamp = frame.stamp;
  } else {
    late_stamps_.push_back({key, frame.stamp});
  }
}

void TraceRecorder::on_set(std::span<const GatherFrame> set, bool complete, GlobalTime now) {
  if (certified_ != nullptr) certified_->observer().on_set(set, complete, now);
  KeptSet kept = {.members = {}, .complete = complete, .range = {}, .now = now};
  const auto [first, last] = std::minmax_element(
      set.begin(), set.end(),
      [](const GatherFrame& a, const GatherFrame& b) { return a.stamp < b.stamp; });
  kept.range = last->stamp - first->stamp;
  for (const GatherFrame& frame : set) {
    kept.members.push_back({{frame.source, register_of(frame.sensor)}, frame.arrival});
  }
  sets_.push_back(std::move(kept));
}

template <class Thing>
void TraceRecorder::take(std::vector<Thing>& list, Thing thing) {
  const TrueTime begin = begin_of(thing);
  const std::uint64_t events = events_of(thing);
  if (begin < trace_.options.from || begin >= trace_.options.to) {
    trace_.left_out.outside += events;
  } else if (begin >= trace_.left_out.cut_at) {
    trace_.left_out.too_many += events;
  } else {
    list.push_back(std::move(thing));
    kept_events_ += events;
    if (kept_events_ / 2 > trace_.options.max_events) cut_to_limit();
  }
}

template <class Function>
void TraceRecorder::for_each_list(const Function& function) {
  function(trace_.pulses);
  function(trace_.frames);
  function(trace_.messages);
  function(trace_.clocks);
  function(trace_.adjustments);
  function(trace_.sessions);
}

void TraceRecorder::cut_to_limit() {
  std::vector<std::pair<TrueTime, std::uint64_t>> things;
  for_each_list([&](const auto& list) {
    for (const auto& thing : list) things.emplace_back(begin_of(thing), events_of(thing));
  });
  std::sort(things.begin(), things.end());
  std::uint64_t events = trace_.capture_start ? 1 : 0;
  for (const auto& [begin, of_thing] : things) {
    events += of_thing;
    if (events > trace_.options.max_events) return cut_at(begin);
  }
}

void TraceRecorder::cut_at(TrueTime instant) {
  trace_.left_out.cut_at = instant;
  kept_events_ = 0;
  for_each_list([&](auto& list) {
    std::erase_if(list, [&](const auto& thing) {
      const bool late = begin_of(thing) >= instant;
      (late ? trace_.left_out.too_many : kept_events_) += events_of(thing);
      return late;
    });
  });
}

Trace TraceRecorder::finish() {
  resolve_adjustments();
  resolve_sessions();
  sort_by_begin();
  index_frames();
  mark_leaders();
  cut_to_limit();
  index_frames();
  resolve_stamps();
  resolve_sets();
  return std::move(trace_);
}

void TraceRecorder::sort_by_begin() {
  for_each_list([](auto& list) {
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return begin_of(a) < begin_of(b); });
  });
}

Trace record_trace(const scenarios::Scenario& scenario, const evaluation::PipelineChoice& choice,
                   std::uint64_t seed, RecordingSource& source, const TraceOptions& options) {
  const evaluation::ScorerSetup setup = evaluation::scorer_setup(scenario, choice);
  evaluation::PipelineScorer scorer(setup);
  std::optional<evaluation::CertifiedScoring> certified;
  std::optional<TraceRecorder> recorder;
  if (options.certify) {
    evaluation::check_certifiable(scenario);
    certified.emplace(scorer, *options.certify, setup.stream);
    recorder.emplace(*certified, scorer, setup.stream, options);
  } else {
    recorder.emplace(scorer, setup.stream, options);
  }
  evaluation::SeedScore score =
      evaluation::score_run(source, choice, seed, scorer, *recorder, &*recorder);
  Trace trace = recorder->finish();
  trace.program_failures = std::move(score.program_failures);
  trace.scenario = scenario.name;
  trace.derivation = scenario.derivation;
  trace.pipeline = choice.pipeline.name;
  trace.seed = seed;
  return trace;
}

// Anchors are at the start of the world and at a frame every second.
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

template <class Thing>
void TraceRecorder::keep_window(std::vector<Thing>& list) {
  std::erase_if(list, [this](const Thing& thing) {
    const TrueTime begin = begin_of(thing);
    const bool wanted = begin >= trace_.options.from && begin < trace_.options.to;
    if (!wanted) trace_.left_out.outside += events_of(thing);
    return !wanted;
  });
}

void TraceRecorder::resolve_adjustments() {
  for (TraceAdjustment& adjustment : trace_.adjustments) {
    adjustment.at = true_time(adjustment.host, adjustment.at_steady);
  }
  keep_window(trace_.adjustments);
}

void TraceRecorder::resolve_sessions() {
  for (TraceSession& session : trace_.sessions) {
    session.at = true_time(session.last.slave, session.begin_steady);
    session.end = true_time(session.last.slave, session.last.end);
  }
  keep_window(trace_.sessions);
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

// Marks the first frame of each set: the set is counted and left out with it.
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
  std::vector<double> bounds_ms;
  if (certified_ != nullptr) bounds_ms = certified_->bounds_ms();
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    const KeptSet& kept = sets_[i];
    TraceSet set = {.frames = {},
                    .members = kept.members.size(),
                    .complete = kept.complete,
                    .range = kept.range,
                    .certified_ms = {},
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
    if (i < bounds_ms.size() && std::isfinite(bounds_ms[i])) set.certified_ms = bounds_ms[i];
    if (!set.frames.empty()) trace_.sets.push_back(std::move(set));
  }
}

std::vector<std::string> left_out_notes(const Trace& trace) {
  std::vector<std::string> notes;
  const TraceLeftOut& left_out = trace.left_out;
  if (left_out.outside > 0) {
    notes.push_back(fmt::format("{} left out: outside the window of --from-ms, --to-ms",
                                counted(left_out.outside, "event")));
  }
  if (left_out.too_many > 0) {
    notes.push_back(
        fmt::format("{} left out, all from {:.6f} ms after true zero on: more than --max-events "
                    "{}; raise it, or "
                    "choose a window with --from-ms and --to-ms",
                    counted(left_out.too_many, "event"), to_ms(left_out.cut_at.time_since_epoch()),
                    trace.options.max_events));
  }
  return notes;
}

}  // namespace simbench::reports
