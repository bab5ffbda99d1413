#include "recording/rs_csv_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "recording/text_fields.h"

namespace simbench {
namespace {

struct ExtraColumn {
  const char* heading;
  std::vector<double> FrameColumns::*values;
};
constexpr ExtraColumn kExtraColumns[] = {{"exposure_us", &FrameColumns::exposure_us},
                                         {"bytes", &FrameColumns::bytes},
                                         {"temperature_c", &FrameColumns::temperature_c}};

// "Depth 0" in the two cells of its type and index.
std::string stream_cells(const std::string& stream) {
  const std::size_t blank = stream.rfind(' ');
  if (blank == std::string::npos) return csv_cell(stream) + ",0";
  return csv_cell(stream.substr(0, blank)) + ',' + csv_cell(stream.substr(blank + 1));
}

}  // namespace

std::string rs_csv_text(std::span<const RecordedStream> streams) {
  const bool are_counted = std::ranges::all_of(streams, &RecordedStream::counted);
  const bool have_names = std::ranges::any_of(
      streams, [](const RecordedStream& stream) { return !stream.camera.empty(); });
  std::vector<ExtraColumn> extras;
  for (const ExtraColumn& extra : kExtraColumns) {
    const auto has = [&](const RecordedStream& stream) {
      return !(stream.columns.*extra.values).empty();
    };
    if (std::ranges::any_of(streams, has)) extras.push_back(extra);
  }
  std::string text = "Stream Type,Index,";
  text += are_counted ? "F#,HW Timestamp (ms),Host Timestamp(ms)"
                      : "HW Timestamp (ms),Host Timestamp(ms)";
  if (have_names) text += ",camera,host";
  for (const ExtraColumn& extra : extras) text += std::string(",") + extra.heading;
  text += '\n';
  for (const RecordedStream& stream : streams) {
    const std::string begin = stream_cells(stream.stream);
    const std::string names = ',' + csv_cell(stream.camera) + ',' + csv_cell(stream.host);
    for (std::size_t i = 0; i < stream.frames.size(); ++i) {
      const StampedFrame& frame = stream.frames[i];
      text += begin;
      if (are_counted) text += fmt::format(",{}", frame.counter);
      text += fmt::format(",{},{}", ms_text(frame.sensor), ms_text(frame.arrival));
      if (have_names) text += names;
      for (const ExtraColumn& extra : extras) {
        const std::vector<double>& values = stream.columns.*extra.values;
        text += ',' + (i < values.size() ? csv_cell(values[i]) : std::string());
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace simbench
