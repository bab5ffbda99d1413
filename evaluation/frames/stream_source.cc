#include "evaluation/frames/stream_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <tuple>

#include "algorithms/device_time/unwrap.h"
#include "algorithms/gathering/genlock_order.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

// The recording's counters of a stream's frames.
std::vector<std::uint32_t> counters_of(const RecordedStream& stream) {
  std::vector<std::uint32_t> counters = {static_cast<std::uint32_t>(stream.frames[0].counter)};
  for (const FrameGap& gap : frame_gaps(unwrapped(stream.frames), stream.counted)) {
    counters.push_back(counters.back() + 1 + static_cast<std::uint32_t>(gap.lost));
  }
  return counters;
}

std::optional<Nanoseconds> common_period(const std::vector<const RecordedStream*>& streams) {
  std::vector<double> periods;
  for (const RecordedStream* stream : streams) {
    const Nanoseconds period = median_period(unwrapped(stream->frames));
    if (period >= Microseconds(1)) periods.push_back(to_ms(period));
  }
  if (periods.empty()) return std::nullopt;
  const Nanoseconds period = from_ms(median(std::move(periods)));
  return period <= std::chrono::hours(1) ? std::optional(period) : std::nullopt;
}

// The pulses that a stream's frames span by GenLock order.
std::int64_t pulses_by_order(const RecordedStream& stream, Nanoseconds period) {
  GenlockOrder order(period, GenlockOrder::Variant::kReanchored);
  DeviceStampUnwrapper unwrapper;
  std::int64_t last = 0;
  for (const StampedFrame& frame : stream.frames) {
    last = std::max(last, order.next(unwrapper.unwrap(register_of(frame.sensor))));
  }
  return last + 1;
}

// The periods from a stream's first arrival to its last one.
std::int64_t pulses_by_arrival(const RecordedStream& stream, Nanoseconds first,
                               Nanoseconds period) {
  Nanoseconds last = first;
  for (const StampedFrame& frame : stream.frames) last = std::max(last, frame.arrival);
  return static_cast<std::int64_t>(difference_ms(last.count(), first.count()) / to_ms(period)) + 2;
}

}  // namespace

DeviceStamp register_of(Nanoseconds sensor) {
  return {static_cast<std::uint32_t>(std::chrono::round<Microseconds>(sensor).count())};
}

StreamSource::StreamSource(const std::vector<RecordedStream>& streams, const std::string& kind,
                           bool genlock)
    : genlock_(genlock) {
  for (const RecordedStream& stream : streams) {
    if (stream.stream != kind || stream.frames.empty()) continue;
    streams_.push_back(&stream);
    counters_.push_back(counters_of(stream));
    const auto host = std::ranges::find(hosts_, stream.host);
    host_of_.push_back(static_cast<std::uint32_t>(host - hosts_.begin()));
    if (host == hosts_.end()) hosts_.push_back(stream.host);
  }
  period_ = common_period(streams_);
}

Nanoseconds StreamSource::first_arrival_range() const {
  if (streams_.empty()) return {};
  const auto first = [](const RecordedStream* stream) { return stream->frames.front().arrival; };
  const auto [least, most] = std::ranges::minmax_element(streams_, {}, first);
  return first(*most) - first(*least);
}

std::vector<StreamSource::Place> StreamSource::order_of_arrival() const {
  struct Arrival {
    Nanoseconds latest;
    Place place;
  };
  std::vector<Arrival> all;
  for (std::uint32_t camera = 0; camera < streams_.size(); ++camera) {
    Nanoseconds latest = Nanoseconds::min();
    const std::vector<StampedFrame>& frames = streams_[camera]->frames;
    for (std::uint32_t i = 0; i < frames.size(); ++i) {
      latest = std::max(latest, frames[i].arrival);
      all.push_back({latest, {camera, i}});
    }
  }
  std::ranges::sort(all, [](const Arrival& a, const Arrival& b) {
    return std::tie(a.latest, a.place.camera, a.place.frame) <
           std::tie(b.latest, b.place.camera, b.place.frame);
  });
  std::vector<Place> order;
  order.reserve(all.size());
  for (const Arrival& arrival : all) order.push_back(arrival.place);
  return order;
}

// Enough for every frame, within what a table of pulses may take.
std::int64_t StreamSource::pulses(RecordingCost& cost) const {
  constexpr std::int64_t kMostPeriodsPerFrame = 64;
  Nanoseconds first = Nanoseconds::max();
  std::size_t frames = 0;
  for (const RecordedStream* stream : streams_) {
    first = std::min(first, stream->frames.front().arrival);
    frames = std::max(frames, stream->frames.size());
  }
  std::int64_t pulses = 1;
  for (const RecordedStream* stream : streams_) {
    pulses = std::max(pulses, genlock_ ? pulses_by_order(*stream, *period_)
                                       : pulses_by_arrival(*stream, first, *period_));
  }
  const std::int64_t most = 1024 + kMostPeriodsPerFrame * static_cast<std::int64_t>(frames);
  if (pulses <= most) return pulses;
  cost.notes.push_back(fmt::format(
      "its frames lie in {} frame periods, allowed {}: frames after those are not scored (stamps "
      "jump, or the recording was paused for long)",
      pulses, most));
  return most;
}

RecordingCost StreamSource::record(const RecordingRequest& /*request*/, RecordingSink& sink) {
  constexpr std::size_t kFramesInBlock = 1024;
  if (!period_) {
    throw RecordingFailed(
        "no camera has a frame period from 1 us to 1 h, by which frames are matched");
  }
  RecordingCost cost;
  RigLayout layout{.hosts = static_cast<std::uint32_t>(hosts_.size()),
                   .cameras = {},
                   .frame_rate_hz = 1e9 / static_cast<double>(period_->count()),
                   .pulses = pulses(cost)};
  for (const std::uint32_t host : host_of_) layout.cameras.push_back({host});
  sink.on_start(layout);
  std::vector<FrameRecord> block;
  for (const Place& place : order_of_arrival()) {
    const RecordedStream& stream = *streams_[place.camera];
    const StampedFrame& frame = stream.frames[place.frame];
    block.push_back(
        {.camera = place.camera,
         .domain = stream.stamped_by_host ? StampDomain::kSystemTime : StampDomain::kHardwareClock,
         .counter = counters_[place.camera][place.frame],
         .sensor = register_of(frame.sensor),
         .frame = register_of(frame.sensor),
         .backend = HostTime(frame.arrival),
         .arrival = HostTime(frame.arrival),
         .arrival_steady = SteadyTime(frame.arrival)});
    if (block.size() < kFramesInBlock) continue;
    sink.on_frames(block, {});
    block.clear();
  }
  if (!block.empty()) sink.on_frames(block, {});
  return cost;
}

}  // namespace simbench::evaluation
