#include "recording/recorded_stream_sink.h"

#include <string>

namespace simbench {
namespace {

std::string name_of(const std::vector<std::string>& names, std::size_t number, const char* kind) {
  return number < names.size() ? names[number] : kind + std::to_string(number);
}

}  // namespace

RecordedStream& RecordedStreamSink::stream_of(const FrameRecord& frame) {
  const auto [place, is_new] = places_.try_emplace({frame.camera, frame.stream}, streams_.size());
  if (is_new) {
    const std::uint32_t host = layout_.cameras.at(frame.camera).host;
    streams_.push_back({.camera = name_of(description_.cameras, frame.camera, "camera"),
                        .host = name_of(description_.hosts, host, "host"),
                        .stream = std::string(scenarios::to_text(frame.stream)),
                        .frames = {},
                        .realsense = true});
  }
  return streams_[place->second];
}

void RecordedStreamSink::on_frames(std::span<const FrameRecord> frames,
                                   std::span<const FrameTruth> /*truths*/) {
  for (const FrameRecord& frame : frames) {
    RecordedStream& stream = stream_of(frame);
    stream.frames.push_back({.counter = frame.counter,
                             .sensor = Nanoseconds(std::int64_t{frame.sensor.us} * 1000),
                             .arrival = frame.arrival_steady.time_since_epoch()});
    stream.set(stream.columns.exposure_us, frame.exposure_us);
    if (frame.backend != HostTime{}) {
      stream.set(stream.columns.backend_ms, to_ms(frame.backend - frame.arrival));
    }
  }
}

}  // namespace simbench
