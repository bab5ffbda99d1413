#include "app/inspection.h"

#include <filesystem>
#include <utility>

#include "app/recorded_streams.h"
#include "app/stream_run.h"
#include "recording/rs_csv.h"

namespace simbench::app {

reports::Inspection inspected(const std::string& path, const bags::FileOptions& options,
                              const std::vector<std::string>& device_times,
                              const ReadProgress& progress) {
  reports::Inspection found{.file = path};
  if (!std::filesystem::exists(path) || !bags::is_bag(path)) {
    found.recording = recorded_streams({path}, options, progress);
  } else {
    found.bag = bags::scan_recording(path, camera_names({path}).front(),
                                     {.topics = options.topics, .all_topics = true}, progress);
    found.recording = {std::move(found.bag->streams), std::move(found.bag->notes)};
  }
  if (device_times.empty()) return found;
  found.stamps = stamped_streams(found.recording.streams, device_times, "--device-times");
  return found;
}

}  // namespace simbench::app
