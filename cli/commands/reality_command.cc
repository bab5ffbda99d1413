#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/progress.h"
#include "evaluation/reality/reality.h"
#include "reports/reality/reality_report.h"
#include "scenarios/document.h"
#include "scenarios/reality.h"

namespace simbench::cli {
namespace {

constexpr const char* kRealityExamples = R"(
Examples:
  simbench reality
  simbench reality chrony_chain --seeds 3 --unknown
  simbench reality --format json > reality.json

Runs the clocks of the scenarios that predict recordings of real rigs whose truth was measured, and
prints measured and predicted figures side by side (docs/reality.md).

Exit status: 0 ok, whatever the ratios; 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct RealityCommandOptions {
  std::vector<std::string> names;
  evaluation::RealityOptions reality;
  std::string format;
};

std::vector<const scenarios::RealRecording*> chosen(const std::vector<std::string>& names) {
  std::vector<const scenarios::RealRecording*> recordings;
  std::vector<std::string> known;
  for (const scenarios::RealRecording& recording : scenarios::real_recordings()) {
    known.push_back(recording.name);
    if (names.empty() || std::ranges::count(names, recording.name) > 0) {
      recordings.push_back(&recording);
    }
  }
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) > 0) continue;
    throw scenarios::InputError(fmt::format("RECORDING: found \"{}\", allowed: {}",
                                            scenarios::shown_text(name), fmt::join(known, ", ")));
  }
  return recordings;
}

int reality(const RealityCommandOptions& options) {
  std::vector<reports::RealityResult> results;
  for (const scenarios::RealRecording* recording : chosen(options.names)) {
    evaluation::RealityOptions run = options.reality;
    run.cancel = &app::InterruptHandler::flag();
    auto rows = watched<std::vector<evaluation::RealityRow>>(
        [&](const evaluation::Progress& progress) {
          return std::make_optional(evaluation::compare_with_reality(
              *recording,
              [](const scenarios::Scenario& scenario) { return app::simulated_clocks(scenario); },
              run, progress));
        },
        {.unit = "world"});
    if (!rows) return kInterrupted;
    results.push_back({.recording = recording, .rows = std::move(*rows)});
  }
  print_result_in(options.format, [&results](const std::string& format) {
    return format == "json" ? reports::reality_json(results)
                            : reports::drawn_as(format, reports::reality_document(results));
  });
  return kOk;
}

}  // namespace

void add_reality_command(CommandLine& line) {
  auto options = std::make_shared<RealityCommandOptions>();
  Command command(line, "reality",
                  "Measured figures of real rigs beside what the bench predicts of them");
  command.texts("names", "RECORDING...", options->names, "Recordings by name. Default: all");
  command.count("--seeds", options->reality.seeds,
                "How many seeds. Default: as the recording says");
  command.jobs(options->reality.jobs);
  command.flag("--unknown", options->reality.spans_unknown,
               "Also run with the other values of what the publications do not give");
  command.format(options->format, {"table", "markdown", "latex", "json"});
  command.footer(kRealityExamples);
  command.runs([options] { return reality(*options); });
}

}  // namespace simbench::cli
