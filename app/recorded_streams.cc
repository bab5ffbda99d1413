#include "app/recorded_streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "app/ibl_recording.h"
#include "recording/dataset_folder.h"
#include "recording/recorded_stream_sink.h"
#include "recording/recording_folder.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

RecordedStreams streams_of_folder(const std::string& path) {
  const RecordingFolder folder(path);
  if (folder.captures().empty()) {
    throw scenarios::InputError(fmt::format("{}: found no capture", path));
  }
  RecordedStreams found;
  const RecordedCapture& capture = folder.captures().front();
  if (folder.captures().size() > 1) {
    found.notes.push_back(fmt::format("{}: of {} captures that of {}, seed {}", path,
                                      folder.captures().size(), capture.pipeline, capture.seed));
  }
  RecordedStreamSink sink(folder.description());
  folder.play(0, sink);
  found.streams = sink.take();
  return found;
}

}  // namespace

std::optional<std::string> recording_folder_of(const std::vector<std::string>& inputs) {
  const auto folder = std::ranges::find_if(inputs, [](const std::string& path) {
    return std::filesystem::is_directory(path) && !bags::is_bag(path) &&
           dataset_files(path).empty();
  });
  if (folder == inputs.end()) return std::nullopt;
  if (inputs.size() == 1) return *folder;
  throw scenarios::InputError(fmt::format(
      "{}: found among {} inputs, allowed one recording folder, or files, folders of rosbag2 and "
      "of CSV files",
      *folder, inputs.size()));
}

RecordedStreams recorded_streams(const std::vector<std::string>& paths,
                                 const bags::FileOptions& options, const ReadProgress& progress) {
  if (const auto folder = recording_folder_of(paths)) return streams_of_folder(*folder);
  const std::vector<std::string> inputs = with_dataset_files(paths);
  std::vector<std::string> others = inputs;
  std::erase_if(others, is_ibl_recording);
  RecordedStreams found;
  if (!others.empty()) found = bags::read_recorded_files(others, options, progress);
  if (others.size() == inputs.size()) return found;
  check_given_once(inputs);
  const std::vector<std::string> names = camera_names(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!is_ibl_recording(inputs[i])) continue;
    RecordedStream& stream = found.streams.emplace_back();
    stream.camera = stream.host = names[i];
    stream.stream = "Color 0";
    stream.counted = !inputs[i].ends_with(".ssv");
    stream.frames = read_ibl_recording(inputs[i]);
    stream.origin.file = inputs[i];
  }
  return found;
}

}  // namespace simbench::app
