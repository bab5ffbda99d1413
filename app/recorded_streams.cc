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

std::optional<std::string> recording_folder_of(const std::vector<std::string>& inputs) {
  const auto folder = std::ranges::find_if(inputs, [](const std::string& path) {
    return std::filesystem::is_directory(path) && !bags::is_bag(path);
  });
  if (folder == inputs.end()) return std::nullopt;
  if (inputs.size() == 1) return *folder;
  throw scenarios::InputError(fmt::format(
      "{}: found among {} inputs, allowed one recording folder, or files and folders of "
      "rosbag2",
      *folder, inputs.size()));
}

RecordedStreams recorded_streams(const std::vector<std::string>& inputs,
                                 const bags::FileOptions& options, const ReadProgress& progress) {
  if (const auto folder = recording_folder_of(inputs)) return streams_of_folder(*folder);
  return bags::read_recorded_files(inputs, options, progress);
}

}  // namespace simbench::app
