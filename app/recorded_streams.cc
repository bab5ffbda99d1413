#include "app/recorded_streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "recording/camera_streams.h"
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
  CameraStreamSink sink(folder.description());
  folder.play(0, sink);
  found.streams = sink.take();
  return found;
}

}  // namespace

RecordedStreams recorded_streams(const std::vector<std::string>& inputs) {
  const auto folder = std::ranges::find_if(
      inputs, [](const std::string& path) { return std::filesystem::is_directory(path); });
  if (folder == inputs.end()) return read_recordings(inputs);
  if (inputs.size() == 1) return streams_of_folder(*folder);
  throw scenarios::InputError(
      fmt::format("{}: found among {} inputs, allowed one recording folder or CSV files", *folder,
                  inputs.size()));
}

}  // namespace simbench::app
