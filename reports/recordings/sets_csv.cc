#include "reports/recordings/sets_csv.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "bags/frame_track.h"
#include "evaluation/frames/camera_statistics.h"
#include "recording/text_fields.h"

namespace simbench::reports {
namespace {

std::string message_of(const RecordedStream& stream, std::size_t frame) {
  const std::vector<std::uint64_t>& messages = stream.origin.messages;
  if (frame >= messages.size() || messages[frame] == bags::kNoMessage) return "";
  return std::to_string(messages[frame]);
}

}  // namespace

void write_sets_csv(const std::vector<evaluation::GatheredSet>& sets,
                    const std::vector<const RecordedStream*>& streams, std::ostream& out) {
  out << "set,complete,camera,stream,file,topic,message,counter,sensor_ns,arrival_ns,stamp_ns\n";
  for (std::size_t number = 0; number < sets.size(); ++number) {
    for (const evaluation::GatheredFrame& member : sets[number].frames) {
      const RecordedStream& stream = *streams[member.camera];
      const StampedFrame& frame = stream.frames[member.frame];
      out << fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{}\n", number, sets[number].complete ? "yes" : "no",
          csv_cell(stream.camera), csv_cell(stream.stream), csv_cell(stream.origin.file),
          csv_cell(stream.origin.topic), message_of(stream, member.frame), frame.counter,
          frame.sensor.count(), frame.arrival.count(), nanoseconds_of(member.stamp));
    }
  }
}

void write_stamps_csv(const std::vector<evaluation::StampedStream>& stamped, std::ostream& out) {
  out << "camera,stream,frame,sensor_ms,arrival_ms";
  for (std::size_t i = 0; i < stamped.size() && stamped[i].stream == stamped[0].stream; ++i) {
    out << ",global_ms_" << csv_cell(stamped[i].device_time);
  }
  out << '\n';
  for (std::size_t begin = 0, end = 0; begin < stamped.size(); begin = end) {
    const RecordedStream& stream = *stamped[begin].stream;
    while (end < stamped.size() && stamped[end].stream == &stream) ++end;
    const std::string name = csv_cell(stream.camera) + "," + csv_cell(stream.stream);
    const std::vector<StampedFrame> frames = evaluation::unwrapped(stream.frames);
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      out << name << ',' << frames[frame].counter << ',' << ms_text(frames[frame].sensor) << ','
          << ms_text(frames[frame].arrival);
      for (std::size_t i = begin; i < end; ++i) {
        const std::optional<GlobalTime>& stamp = stamped[i].stamps[frame];
        out << ',' << (stamp ? ms_text(stamp->time_since_epoch()) : "");
      }
      out << '\n';
    }
  }
}

}  // namespace simbench::reports
