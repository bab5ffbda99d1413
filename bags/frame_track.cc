#include "bags/frame_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

using StampMember = std::int64_t RawFrame::*;

struct StampField {
  StampMember member;
  std::int64_t unit_ns;
  const char* name;
};

constexpr std::int64_t kMicrosecondNs = 1'000;
constexpr std::int64_t kMillisecondNs = 1'000'000;
constexpr double kMostFrames = 0.95;  // a source that as many frames have serves for all

// Stamps above this count from 1970: no camera has been on for as long.
constexpr std::int64_t kLeastEpochNs =
    std::chrono::duration_cast<Nanoseconds>(std::chrono::hours(24 * 365 * 20)).count();

struct MetadataName {
  std::string_view name;
  StampMember member;
};
// The SDK's names, then those that realsense-ros makes of them.
constexpr std::array<MetadataName, 16> kMetadataNames = {{
    {"Frame Counter", &RawFrame::counter},
    {"Sensor Timestamp", &RawFrame::sensor_us},
    {"Frame Timestamp", &RawFrame::frame_us},
    {"Time Of Arrival", &RawFrame::arrival_ms},
    {"Backend Timestamp", &RawFrame::backend_ms},
    {"frame_number", &RawFrame::counter},
    {"frame_counter", &RawFrame::counter},
    {"sensor_timestamp", &RawFrame::sensor_us},
    {"hw_timestamp", &RawFrame::frame_us},
    {"time_of_arrival", &RawFrame::arrival_ms},
    {"backend_timestamp", &RawFrame::backend_ms},
    {"Arrival Timestamp", &RawFrame::arrival_ms},
    {"Actual Exposure", &RawFrame::exposure_us},
    {"actual_exposure", &RawFrame::exposure_us},
    {"Raw Frame Size", &RawFrame::bytes},
    {"raw_frame_size", &RawFrame::bytes},
}};

// A product that cannot overflow; nothing for a stamp that is not there or beyond all time.
std::optional<std::int64_t> stamp_ns(const RawFrame& frame, const StampField& source) {
  const std::int64_t value = frame.*source.member;
  if (value == kNoStamp) return std::nullopt;
  const std::int64_t most = std::numeric_limits<std::int64_t>::max() / 4 / source.unit_ns;
  if (value > most || value < -most) return std::nullopt;
  return value * source.unit_ns;
}

bool serves(const std::vector<RawFrame>& frames, const StampField& source) {
  std::size_t having = 0;
  bool differs = false;
  std::optional<std::int64_t> first;
  for (const RawFrame& frame : frames) {
    const std::optional<std::int64_t> stamp = stamp_ns(frame, source);
    if (!stamp) continue;
    ++having;
    if (!first) first = stamp;
    differs = differs || *stamp != *first;
  }
  const bool most = static_cast<double>(having) >= kMostFrames * static_cast<double>(frames.size());
  return having > 0 && most && (differs || having == 1);
}

template <std::size_t size>
const StampField* first_that_serves(const std::array<StampField, size>& sources,
                                    const std::vector<RawFrame>& frames) {
  const auto found =
      std::find_if(sources.begin(), sources.end(),
                   [&frames](const StampField& source) { return serves(frames, source); });
  return found == sources.end() ? nullptr : &*found;
}

bool is_sdk(const FrameTrack& track) { return track.camera.kind == TopicKind::kSdkImage; }

const StampField* stamps_of(const FrameTrack& track) {
  static constexpr std::array<StampField, 3> kSources = {{
      {&RawFrame::sensor_us, kMicrosecondNs, "SENSOR_TIMESTAMP (camera's clock, us)"},
      {&RawFrame::frame_us, kMicrosecondNs, "FRAME_TIMESTAMP (camera's clock, us)"},
      {&RawFrame::header_ns, 1, "header stamp"},
  }};
  return first_that_serves(kSources, track.frames);
}

const StampField* arrivals_of(const FrameTrack& track) {
  static constexpr std::array<StampField, 3> kSources = {{
      {&RawFrame::arrival_ms, kMillisecondNs, "TIME_OF_ARRIVAL (host's clock, ms)"},
      {&RawFrame::backend_ms, kMillisecondNs, "BACKEND_TIMESTAMP (host's clock, ms)"},
      {&RawFrame::log_ns, 1, "log time (recorder's clock)"},
  }};
  static constexpr StampField kLog = kSources.back();
  if (!is_sdk(track)) return &kLog;
  const StampField* source = first_that_serves(kSources, track.frames);
  return source != nullptr ? source : &kLog;
}

// A header's stamp is a computer's, unless the bag says otherwise or it cannot count from 1970.
bool is_of_host(const FrameTrack& track, const StampField& source, std::int64_t first_ns) {
  if (source.member != &RawFrame::header_ns) return false;
  if (!track.domain.empty()) {
    return track.domain != "Hardware Clock" && track.domain != "hardware_clock";
  }
  return first_ns > kLeastEpochNs;
}

// Whether the camera counted the frames.
bool are_counted(const std::vector<RawFrame>& frames) {
  const bool all = std::all_of(frames.begin(), frames.end(),
                               [](const RawFrame& frame) { return frame.counter >= 0; });
  return all && std::any_of(frames.begin(), frames.end(), [&frames](const RawFrame& frame) {
           return frame.counter != frames.front().counter;
         });
}

// What the metadata say beside stamps.
void add_columns(const RawFrame& frame, RecordedStream& stream) {
  const auto set = [&stream](std::vector<double>& column, std::int64_t value) {
    if (value != kNoStamp) stream.set(column, static_cast<double>(value));
  };
  set(stream.columns.exposure_us, frame.exposure_us);
  set(stream.columns.bytes, frame.bytes);
  if (frame.backend_ms == kNoStamp) return;
  stream.set(stream.columns.backend_ms,
             static_cast<double>(frame.backend_ms) - to_ms(stream.frames.back().arrival));
}

std::string stamp_text(const StampField& source, bool of_host) {
  if (source.member != &RawFrame::header_ns) return source.name;
  return fmt::format("header stamp ({})", of_host ? "a computer's clock" : "camera's clock");
}

}  // namespace

void RawFrame::set(std::string_view name, std::int64_t value) {
  const auto known = std::find_if(kMetadataNames.begin(), kMetadataNames.end(),
                                  [name](const MetadataName& entry) { return entry.name == name; });
  if (known != kMetadataNames.end()) this->*known->member = value;
}

void RawFrame::take_metadata(const RawFrame& part) {
  for (const MetadataName& entry : kMetadataNames) {
    if (part.*entry.member != kNoStamp) this->*entry.member = part.*entry.member;
  }
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  return value;
}

bool make_stream(const FrameTrack& track, const std::string& place, RecordedStream& stream,
                 std::vector<std::string>& notes) {
  const std::string topic = printable_name(track.topic_name);
  const StampField* stamps = stamps_of(track);
  if (stamps == nullptr) {
    notes.push_back(fmt::format("{}: {}: left out: its {} have no stamps, or all the same", place,
                                topic, counted(track.frames.size(), "message")));
    return false;
  }
  const StampField* arrivals = arrivals_of(track);
  stream.counted = are_counted(track.frames);
  stream.frames.reserve(track.frames.size());
  stream.origin.messages.reserve(track.frames.size());
  for (const RawFrame& frame : track.frames) {
    const std::optional<std::int64_t> sensor = stamp_ns(frame, *stamps);
    const std::optional<std::int64_t> arrival = stamp_ns(frame, *arrivals);
    if (!sensor || !arrival) continue;
    const std::uint64_t counter = stream.counted ? static_cast<std::uint64_t>(frame.counter)
                                                 : std::uint64_t{stream.frames.size()};
    stream.frames.push_back({counter, Nanoseconds(*sensor), Nanoseconds(*arrival)});
    stream.origin.messages.push_back(frame.message);
    add_columns(frame, stream);
  }
  stream.complete_columns();
  if (const std::size_t lacking = track.frames.size() - stream.frames.size(); lacking > 0) {
    notes.push_back(fmt::format("{}: {}: {} left out, which have no {}", place, topic,
                                counted(lacking, "frame"), stamps->name));
  }
  if (stream.frames.empty()) return false;
  stream.stamped_by_host = is_of_host(track, *stamps, stream.frames.front().sensor.count());
  const bool has_metadata =
      std::ranges::any_of(track.frames, [](const RawFrame& f) { return f.arrival_ms != kNoStamp; });
  stream.realsense = is_sdk(track) || has_metadata;
  stream.origin.file = place;
  stream.origin.topic = track.topic_name;
  stream.origin.stamps = stamp_text(*stamps, stream.stamped_by_host);
  stream.origin.arrivals = arrivals->name;
  return true;
}

}  // namespace simbench::bags
