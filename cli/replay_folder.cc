#include "cli/replay_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "app/interrupt.h"
#include "app/results_text.h"
#include "cli/exit_status.h"
#include "cli/options.h"
#include "cli/watched.h"
#include "evaluation/run/evaluate.h"
#include "recording/recording_folder.h"
#include "reports/archive/archive.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

constexpr std::uint64_t kMostSeeds = 1'000'000;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

scenarios::Scenario scenario_of(const RecordingFolder& recorded, const std::string& folder) {
  const std::string& text = recorded.description().scenario_json;
  if (text.empty()) {
    throw RecordingFolderError(
        fmt::format("{}/manifest.json: /scenario: found null, allowed: a scenario", folder));
  }
  return scenarios::load_scenario_text(text, fmt::format("{}/manifest.json#/scenario", folder));
}

// In the order in which they were recorded, or as asked for.
std::vector<std::string> pipelines_of(const RecordingFolder& recorded,
                                      const FolderReplay& options) {
  std::vector<std::string> known;
  for (const RecordedCapture& capture : recorded.captures()) {
    if (!contains(known, capture.pipeline)) known.push_back(capture.pipeline);
  }
  for (const std::string& name : options.pipelines) {
    if (contains(known, name)) continue;
    throw scenarios::InputError(fmt::format("--pipelines: found '{}', recorded in {}: {}", name,
                                            options.folder, fmt::join(known, ", ")));
  }
  return options.pipelines.empty() ? known : options.pipelines;
}

evaluation::EvaluationOptions plan_of(const RecordingFolder& recorded,
                                      const FolderReplay& options) {
  const auto [first, last] = std::minmax_element(
      recorded.captures().begin(), recorded.captures().end(),
      [](const RecordedCapture& a, const RecordedCapture& b) { return a.seed < b.seed; });
  if (last->seed - first->seed >= kMostSeeds) {
    throw RecordingFolderError(
        fmt::format("{}/manifest.json: found seeds {} and {}, allowed: {} "
                    "in a row",
                    options.folder, first->seed, last->seed, kMostSeeds));
  }
  return {.first_seed = first->seed,
          .seeds = last->seed - first->seed + 1,
          .pipelines = pipelines_of(recorded, options),
          .keep_pulses = !options.output.empty()};
}

void print_notes(const evaluation::Results& results) {
  for (const evaluation::Row& row : results.rows) {
    for (const evaluation::SeedScore& seed : row.seeds) {
      for (const std::string& note : seed.cost.notes) {
        print_note(fmt::format("pipeline {}, seed {}: {}", row.pipeline, seed.seed, note));
      }
    }
  }
}

}  // namespace

int replay_folder(const FolderReplay& options) {
  reports::Provenance provenance;
  provenance.command = options.command;
  provenance.started = std::chrono::system_clock::now();
  const RecordingFolder recorded(options.folder);
  if (recorded.captures().empty()) {
    throw RecordingFolderError(fmt::format("{}: holds no capture", options.folder));
  }
  const scenarios::Scenario scenario = scenario_of(recorded, options.folder);
  const evaluation::EvaluationOptions plan = plan_of(recorded, options);
  std::unique_ptr<reports::OutputFolder> output;
  if (!options.output.empty()) output = std::make_unique<reports::OutputFolder>(options.output);

  const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
    return evaluation::evaluate(
        scenario, [&] { return app::interruptible(make_recorded_source(recorded)); }, plan,
        progress);
  });
  if (!results) return kInterrupted;
  print_warnings(results->warnings);
  print_notes(*results);
  provenance.finished = std::chrono::system_clock::now();
  if (output) {
    reports::write_archive(*output, *results, scenario, provenance);
    print_note("results written to " + options.output);
  }
  print_result(app::results_text(*results, scenario, options.format));
  return kOk;
}

}  // namespace simbench::cli
