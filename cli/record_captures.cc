#include "cli/record_captures.h"

#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "app/interrupt.h"
#include "cli/exit_status.h"
#include "cli/messages.h"
#include "cli/progress.h"

namespace simbench::cli {
namespace {

class Captures {
 public:
  Captures(RecordingSource& source, RecordingWriter& writer) : source_(source), writer_(writer) {}

  // Leaves a capture without an end where it could not be finished.
  void record(const evaluation::PipelineChoice& choice, std::uint64_t seed) {
    const std::string& pipeline = choice.pipeline.name;
    const std::unique_ptr<HostSync> host_sync = choice.host_sync.make(choice.host_sync_parameters);
    RecordingSink& sink = writer_.begin(pipeline, seed);
    try {
      const RecordingCost cost =
          source_.record({.seed = seed, .pipeline = pipeline, .host_sync = host_sync.get()}, sink);
      writer_.end(cost);
      ++recorded_;
      for (const std::string& note : cost.notes) warn(pipeline, seed, note);
    } catch (const RecordingFailed& failure) {
      writer_.abandon({failure.what()});
      warn(pipeline, seed, failure.what());
    } catch (const app::Interrupted&) {
      writer_.abandon({"interrupted"});
      throw;
    }
  }

  std::uint64_t recorded() const { return recorded_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void warn(const std::string& pipeline, std::uint64_t seed, const std::string& text) {
    warnings_.push_back(fmt::format("pipeline {}, seed {}: {}", pipeline, seed, text));
  }

  RecordingSource& source_;
  RecordingWriter& writer_;
  std::uint64_t recorded_ = 0;
  std::vector<std::string> warnings_;
};

// False if it was interrupted.
bool record_all(const std::vector<evaluation::PipelineChoice>& choices, const RecordPlan& plan,
                Captures& captures) {
  const app::InterruptHandler handler;
  Progress progress(std::cerr, progress_style(), "captures");
  const std::uint64_t total = choices.size() * plan.seeds;
  std::uint64_t done = 0;
  try {
    for (std::uint64_t i = 0; i < plan.seeds; ++i) {
      for (const evaluation::PipelineChoice& choice : choices) {
        captures.record(choice, plan.first_seed + i);
        progress.update(++done, total);
      }
    }
    progress.finish();
    return true;
  } catch (const app::Interrupted&) {
    progress.interrupt();
  }
  if (!messages_are_json()) {
    std::cerr << fmt::format("interrupted after {} of {} captures; {} holds what was recorded\n",
                             done, total, plan.folder);
  }
  return false;
}

}  // namespace

int record_captures(const std::vector<evaluation::PipelineChoice>& choices, RecordingSource& source,
                    const RecordPlan& plan, RecordingWriter& writer) {
  Captures captures(source, writer);
  const bool finished = record_all(choices, plan, captures);
  print_warnings(captures.warnings());
  if (!finished) return kInterrupted;
  if (captures.recorded() == 0) {
    print_error("no capture could be made");
    return kBadInput;
  }
  print_note(fmt::format("{} of {} captures recorded in {}", captures.recorded(),
                         choices.size() * plan.seeds, plan.folder));
  return kOk;
}

}  // namespace simbench::cli
