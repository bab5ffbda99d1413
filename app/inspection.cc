#include "app/inspection.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "app/recorded_streams.h"
#include "app/stream_run.h"
#include "recording/dataset_folder.h"
#include "recording/rs_csv.h"

namespace simbench::app {
namespace {

// `name`: of the file, among all.
reports::Inspection inspected_by_itself(const std::string& path, const std::string& name,
                                        const bags::FileOptions& options,
                                        const ReadProgress& progress) {
  reports::Inspection found{.file = path};
  if (std::filesystem::exists(path) && bags::is_bag(path)) {
    found.bag =
        bags::scan_recording(path, name, {.topics = options.topics, .all_topics = true}, progress);
    found.recording = {std::move(found.bag->streams), std::move(found.bag->notes)};
    return found;
  }
  found.is_folder = std::filesystem::is_directory(path);
  found.recording = recorded_streams({path}, options, progress);
  const std::string lone = camera_names({path}).front();  // its name without the others
  for (RecordedStream& stream : found.recording.streams) {
    for (std::string* const named : {&stream.camera, &stream.host}) {
      if (*named == lone) *named = name;
    }
  }
  return found;
}

// What is read of a path, and how much there is to read.
std::uint64_t bytes_of(const std::string& path) {
  return std::filesystem::is_directory(path) && !bags::is_bag(path) ? 0
                                                                    : bags::recording_bytes(path);
}

}  // namespace

std::vector<reports::Inspection> inspected(const std::vector<std::string>& inputs,
                                           const bags::FileOptions& options,
                                           const std::vector<std::string>& device_times,
                                           const ReadProgress& progress) {
  const std::vector<std::string> paths = with_dataset_files(inputs);
  check_given_once(paths);
  const std::vector<std::string> names = camera_names(paths);
  std::uint64_t total = 0;
  for (const std::string& path : paths) total += bytes_of(path);
  std::uint64_t before = 0;
  std::vector<reports::Inspection> all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    all.push_back(
        inspected_by_itself(paths[i], names[i], options, [&](std::uint64_t done, std::uint64_t) {
          if (progress) progress(std::min(before + done, total), total);
        }));
    before += bytes_of(paths[i]);
  }
  std::vector<RecordedStreams*> of_bags;
  std::vector<std::string> names_of_bags;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!all[i].bag) continue;
    of_bags.push_back(&all[i].recording);
    names_of_bags.push_back(names[i]);
  }
  bags::tell_apart(of_bags, names_of_bags);
  if (device_times.empty()) return all;
  for (reports::Inspection& found : all) {
    found.stamps = stamped_streams(found.recording.streams, device_times, "--device-times");
  }
  return all;
}

}  // namespace simbench::app
