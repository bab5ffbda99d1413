// A run as Python has it: simulated now, read from an archive, or scored from a recording folder.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/recordings.h"
#include "cli/input_options.h"
#include "reports/archive/archive.h"
#include "reports/results/results_answer.h"
#include "scenarios/scenario.h"

namespace simbench::python {

// --set /json/pointer=value, the value as JSON.
using Sets = std::vector<std::pair<std::string, std::string>>;

struct RunRequest {
  std::string scenario;
  std::vector<std::string> pipelines;
  Sets sets;
  std::uint64_t seeds = 32;
  std::uint64_t first_seed = 1;
  unsigned jobs = 0;
  bool keep_pulses = true;
  std::string rank_by{};   // a metric; "": what the scenario says
  bool no_levers = false;  // the answer does not look for what would improve the best pipeline
  bool certify = false;    // rows have certified_ms
  std::vector<std::string> command;  // for the archive
};

// A recording to score: a folder, or files with what the options of `simbench replay` say of them.
struct RecordingToScore {
  std::vector<std::string> inputs{};
  std::vector<std::string> topics{};
  std::string columns{};
  std::vector<std::string> pipelines{};
  std::string stream{};
  bool genlock = false;
  bool certify = false;  // rows have certified_ms
  std::string rank_by{};
  std::vector<std::string> command{};  // for the archive
};

// With the pipelines that it states by their algorithms.
scenarios::Scenario load_scenario(const RunRequest& request);

struct Run {
  reports::Archive archive{};                       // with the results
  std::optional<scenarios::Scenario> scenario{};    // nothing: unknown, of a results.json alone
  std::shared_ptr<app::RecordedRun> recorded{};     // of a recording folder
  std::optional<reports::Provenance> provenance{};  // of a run that can be saved
  std::optional<reports::ResultsAnswer> answer{};   // once it was asked for
  bool no_levers = false;
  std::vector<std::string> notes{};

  const evaluation::Results& results() const { return archive.results; }
};

}  // namespace simbench::python
