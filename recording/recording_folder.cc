#include "recording/recording_folder.h"

#include <fmt/format.h>

#include <utility>

#include "algorithms/ports/assert.h"
#include "recording/capture_reader.h"
#include "recording/recording_manifest.h"

namespace simbench {
namespace {

class RecordedSource final : public RecordingSource {
 public:
  explicit RecordedSource(const RecordingFolder& folder) : folder_(folder) {}

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    const auto found = folder_.find(request.pipeline, request.seed);
    if (!found) {
      throw RecordingFailed(fmt::format("pipeline {}, seed {} is not among the recorded captures",
                                        request.pipeline, request.seed));
    }
    const RecordedCapture& capture = folder_.captures()[*found];
    RecordingCost cost = capture.cost;
    cost.notes = capture.notes;
    try {
      folder_.play(*found, sink);
    } catch (const RecordingFolderError& error) {
      cost.notes.push_back(fmt::format("damaged, played up to there: {}", error.what()));
    }
    return cost;
  }

 private:
  const RecordingFolder& folder_;
};

}  // namespace

RecordingFolder::RecordingFolder(std::string folder) : folder_(std::move(folder)) {
  while (folder_.size() > 1 && folder_.ends_with('/')) folder_.pop_back();
  RecordingManifest manifest = read_manifest(folder_);
  description_ = std::move(manifest.description);
  captures_ = std::move(manifest.captures);
  for (RecordedCapture& capture : captures_) {
    if (!capture.complete) {
      capture.notes.emplace_back("the recording has no end: what was written until then is there");
    }
  }
}

std::optional<std::size_t> RecordingFolder::find(const std::string& pipeline,
                                                 std::uint64_t seed) const {
  for (std::size_t i = 0; i < captures_.size(); ++i) {
    if (captures_[i].pipeline == pipeline && captures_[i].seed == seed) return i;
  }
  return std::nullopt;
}

void RecordingFolder::play(std::size_t capture, RecordingSink& sink) const {
  SIMBENCH_ASSERT(capture < captures_.size(), "a capture of this folder");
  const RecordedCapture& played = captures_[capture];
  sink.on_start(played.layout);
  CaptureReader reader(folder_, played);
  while (reader.next()) tell(reader.event(), sink);
}

std::unique_ptr<RecordingSource> make_recorded_source(const RecordingFolder& folder) {
  return std::make_unique<RecordedSource>(folder);
}

}  // namespace simbench
