#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/interrupt.h"
#include "app/paper.h"
#include "cli/command.h"
#include "cli/command_line.h"
#include "cli/commands/commands.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "reconstruction/experiment.h"
#include "reports/paper/paper_document.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

using reconstruction::Reconstruction;
using reconstruction::ReconstructionResults;
using reports::PaperResults;

constexpr const char* kPaperExamples = R"(
Runs what Yoon et al. 2021 measured, at 15 and at 45 fps, and says of each printed number whether it
is a plausible draw of these worlds (inside or outside, with its percentile among the seeds), of
each claim in how many seeds it holds, what is a fit, and what is not reached and why.

Examples:
  simbench paper
  simbench paper -o results/paper          with the figures: results/paper/paper.html
  simbench paper --seeds 1000 --format markdown > tables.md
  simbench report results/paper/18cam_6host_45fps

Table 4 needs a simbench with Embree and Open3D (tools/run --with-reconstruction).

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

constexpr const char* kStudio = "18cam_6host_30fps_studio";
constexpr const char* kReconstructProgram = "simbench-reconstruct";

struct PaperCommand {
  app::PaperOptions run;
  bool no_table_4 = false;
  std::string format;
  std::string output;
  std::vector<std::string> command;
  const Reconstruction* reconstruction = nullptr;
};

// Goes on as the program with the libraries of Table 4, where there is one.
void become_one_with_table_4(const PaperCommand& command) {
  if (command.reconstruction != nullptr || command.no_table_4) return;
  std::error_code error;
  if (!std::filesystem::exists(sibling_program(kReconstructProgram), error)) return;
  become_sibling(kReconstructProgram, command.command);
}

// False after an interruption.
bool add_table_4(const PaperCommand& command, PaperResults& results) {
  if (command.no_table_4) {
    results.no_table_4 = "Left out (--no-table-4).";
    return true;
  }
  if (command.reconstruction == nullptr) {
    results.no_table_4 =
        "Left out: this simbench was built without Embree and Open3D (tools/run "
        "--with-reconstruction builds with them).";
    return true;
  }
  const scenarios::Scenario scenario = scenarios::load_scenario(kStudio, {});
  results.table_4 = watched<ReconstructionResults>(
      [&](const evaluation::Progress& progress) {
        return command.reconstruction->run(
            scenario, [&] { return app::simulated_world(scenario); },
            {.first_seed = command.run.first_seed,
             .jobs = command.run.jobs,
             .cancel = &app::InterruptHandler::flag()},
            [](const reconstruction::ShownMesh&) {}, progress);
      },
      {.unit = "frame set"});
  return results.table_4.has_value();
}

std::string paper_text(const PaperResults& results, const std::string& format) {
  if (format == "json") return reports::paper_json(results);
  return reports::drawn_as(format, reports::paper_document(results));
}

int run_paper(const PaperCommand& command) {
  become_one_with_table_4(command);
  std::optional<app::PaperFolder> folder;
  if (!command.output.empty()) folder.emplace(command.output, command.command);
  std::optional<PaperResults> results = watched<PaperResults>(
      [&](const evaluation::Progress& progress) { return app::run_paper(command.run, progress); });
  if (!results || !add_table_4(command, *results)) return kInterrupted;
  if (folder) {
    const std::optional<bool> written = watched<bool>([&](const evaluation::Progress& progress) {
      folder->write(*results, progress);
      return true;
    });
    if (!written) return kInterrupted;
    print_note(fmt::format("results written to {0}; the page is {0}/paper.html", command.output));
  }
  print_result_in(command.format,
                  [&results](const std::string& format) { return paper_text(*results, format); });
  return kOk;
}

}  // namespace

void add_paper_command(CommandLine& line) {
  auto options = std::make_shared<PaperCommand>();
  options->command = line.arguments;
  options->reconstruction = line.extras.reconstruction;
  Command command(line, "paper", "Run what the paper measured, and print it beside its numbers");
  command.count("--seeds", options->run.seeds,
                "How many seeds of each rate; 72 and more can place a printed value outside.\n"
                "Default: 200");
  command.seed("--first-seed", options->run.first_seed, "The first seed. Default: 1");
  command.jobs(options->run.jobs);
  command.flag("--no-table-4", options->no_table_4,
               "Leave out Table 4, the reconstruction, which takes longest");
  command.format(options->format, {"table", "markdown", "latex", "json"});
  command.output(
      "-o,--output", "DIR", options->output,
      "Write all of it to this folder: paper.html with the figures, paper.txt,\n"
      "paper.json, and the result archive of each rate. Replaces an earlier result there");
  command.footer(kPaperExamples);
  command.runs([options] { return run_paper(*options); });
}

}  // namespace simbench::cli
