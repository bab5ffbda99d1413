#include "app/recorded_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/interrupt.h"
#include "scenarios/loader.h"

namespace simbench::app {
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

}  // namespace

RecordedRun::RecordedRun(const std::string& folder) : path_(folder), folder_(folder) {
  const std::vector<RecordedCapture>& captures = folder_.captures();
  if (captures.empty()) throw RecordingFolderError(fmt::format("{}: holds no capture", folder));
  scenario_ = scenario_of(folder_, folder);
  const auto [first, last] = std::minmax_element(
      captures.begin(), captures.end(),
      [](const RecordedCapture& a, const RecordedCapture& b) { return a.seed < b.seed; });
  if (last->seed - first->seed >= kMostSeeds) {
    throw RecordingFolderError(
        fmt::format("{}/manifest.json: found seeds {} and {}, allowed: {} in a row", folder,
                    first->seed, last->seed, kMostSeeds));
  }
  first_seed_ = first->seed;
  seeds_ = last->seed - first->seed + 1;
}

// In the order in which they were recorded, or as asked for.
std::vector<std::string> RecordedRun::chosen(const std::vector<std::string>& pipelines) const {
  std::vector<std::string> known;
  for (const RecordedCapture& capture : folder_.captures()) {
    if (!contains(known, capture.pipeline)) known.push_back(capture.pipeline);
  }
  for (const std::string& name : pipelines) {
    if (contains(known, name)) continue;
    throw scenarios::InputError(fmt::format("--pipelines: found '{}', recorded in {}: {}", name,
                                            path_, fmt::join(known, ", ")));
  }
  return pipelines.empty() ? known : pipelines;
}

evaluation::Results RecordedRun::evaluate(const std::vector<std::string>& pipelines,
                                          bool keep_pulses,
                                          const evaluation::Progress& progress) const {
  return evaluation::evaluate(
      scenario_, [this] { return interruptible(make_recorded_source(folder_)); },
      {.first_seed = first_seed_,
       .seeds = seeds_,
       .pipelines = pipelines,
       .keep_pulses = keep_pulses},
      progress);
}

std::vector<std::string> capture_notes(const evaluation::Results& results) {
  std::vector<std::string> notes;
  for (const evaluation::Row& row : results.rows) {
    for (const evaluation::SeedScore& seed : row.seeds) {
      for (const std::string& note : seed.cost.notes) {
        notes.push_back(fmt::format("pipeline {}, seed {}: {}", row.pipeline, seed.seed, note));
      }
    }
  }
  return notes;
}

}  // namespace simbench::app
