#include "app/record_captures.h"

#include <fmt/format.h>

#include <memory>

#include "app/interrupt.h"

namespace simbench::app {
namespace {

// Leaves a capture without an end where it could not be finished.
void record(const evaluation::PipelineChoice& choice, std::uint64_t seed, RecordingSource& source,
            RecordingWriter& writer, CapturesMade& made) {
  const std::string& pipeline = choice.pipeline.name;
  const auto warn = [&](const std::string& text) {
    made.warnings.push_back(fmt::format("pipeline {}, seed {}: {}", pipeline, seed, text));
  };
  const std::unique_ptr<HostSync> host_sync = choice.host_sync.make(choice.host_sync_parameters);
  RecordingSink& sink = writer.begin(pipeline, seed);
  try {
    const RecordingCost cost =
        source.record({.seed = seed, .pipeline = pipeline, .host_sync = host_sync.get()}, sink);
    writer.end(cost);
    ++made.recorded;
    for (const std::string& note : cost.notes) warn(note);
  } catch (const RecordingFailed& failure) {
    writer.abandon({failure.what()});
    warn(failure.what());
  } catch (const Interrupted&) {
    writer.abandon({"interrupted"});
    throw;
  }
}

}  // namespace

void record_captures(const std::vector<evaluation::PipelineChoice>& choices,
                     RecordingSource& source, const CapturePlan& plan, RecordingWriter& writer,
                     CapturesMade& made, const evaluation::Progress& progress) {
  const std::uint64_t total = choices.size() * plan.seeds;
  std::uint64_t done = 0;
  for (std::uint64_t i = 0; i < plan.seeds; ++i) {
    for (const evaluation::PipelineChoice& choice : choices) {
      record(choice, plan.first_seed + i, source, writer, made);
      progress(++done, total);
    }
  }
}

}  // namespace simbench::app
