#include "reports/rigs/sets_csv.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "bags/frame_track.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {
namespace {

std::string message_of(const CameraStream& stream, std::size_t frame) {
  const std::vector<std::uint64_t>& messages = stream.origin.messages;
  if (frame >= messages.size() || messages[frame] == bags::kNoMessage) return "";
  return std::to_string(messages[frame]);
}

}  // namespace

void write_sets_csv(const std::vector<evaluation::GatheredSet>& sets,
                    const std::vector<CameraStream>& streams, std::ostream& out) {
  out << "set,complete,camera,stream,file,topic,message,counter,sensor_ns,arrival_ns,stamp_ns\n";
  for (std::size_t number = 0; number < sets.size(); ++number) {
    for (const evaluation::GatheredFrame& member : sets[number].frames) {
      const CameraStream& stream = streams[member.stream];
      const StampedFrame& frame = stream.frames[member.frame];
      out << fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{}\n", number, sets[number].complete ? "yes" : "no",
          csv_cell(stream.camera), csv_cell(stream.stream), csv_cell(stream.origin.file),
          csv_cell(stream.origin.topic), message_of(stream, member.frame), frame.counter,
          frame.sensor.count(), frame.arrival.count(), nanoseconds_of(member.stamp));
    }
  }
}

}  // namespace simbench::reports
