#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/figure_source.h"
#include "app/recordings.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/progress.h"
#include "evaluation/budget/pipeline_budget.h"
#include "evaluation/diagnosis/diagnose.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "evaluation/run/evaluate.h"
#include "recording/collected.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "reports/figures/gnuplot.h"
#include "reports/recordings/diagnose_figure.h"
#include "reports/text/block.h"
#include "reports/text/number_text.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

using reports::Figure;
using reports::FigureEntry;
using reports::FigureScope;
using scenarios::InputError;

constexpr const char* kFigureExamples = R"(
Draws figures of finished results, and of single runs, which it repeats in the simulator. gnuplot
(Debian: gnuplot-nox) draws SVG and PDF; CSV has the data, a line for each point: panel,series,x,y.

Without ARCHIVE and --scenario a figure is drawn of the built-in scenario that has what the paper's
figure shows, and of the paper's pipeline.

Examples:
  simbench figure --list
  simbench figure fig5 -o fig5.svg
  simbench figure fig8 --scenario 18cam_6host_45fps -o fig8.pdf
  simbench figure host_clocks --scenario 18cam_6host_45fps --seed 7 --pipelines ntp_w32time -o h.svg
  simbench figure distributions results/monday -o distributions.csv
  simbench figure phases rig.csv -o phases.svg          of a recording: who follows the trigger
  simbench figure stamp_intervals a.bag b.bag --pipelines hull_300 -o i.svg

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

constexpr std::uint64_t kUsualSeeds = 32;

struct FigureCommand {
  std::string name;
  std::vector<std::string> inputs;  // an archive, or what a recording is in
  InputOptions reading;
  std::string scenario;
  std::vector<std::string> sets;
  std::vector<std::string> pipelines;
  std::optional<std::uint64_t> seed;
  std::uint64_t seeds = kUsualSeeds;
  std::string output;
  bool list = false;
};

const char* drawn_for(FigureScope scope) {
  switch (scope) {
    case FigureScope::kResults:
      return "all seeds";
    case FigureScope::kPipeline:
      return "a pipeline";
    case FigureScope::kSeed:
      return "a seed";
    case FigureScope::kRecording:
      return "a recording";
    case FigureScope::kRun:
      break;
  }
  return "a pipeline and seed";
}

// What is drawn where neither a scenario nor an archive is named.
std::string default_of(const FigureEntry& entry) {
  if (entry.rates.empty()) return entry.scenario;
  std::vector<std::string> of_rates;
  for (const reports::PaperRate& each : entry.rates) {
    of_rates.push_back(fmt::format("{} ({})", each.scenario, each.alias));
  }
  return fmt::format("{}", fmt::join(of_rates, ", "));
}

}  // namespace

std::string figure_list() {
  using reports::Align;
  reports::Table table({{"figure", Align::kLeft},
                        {"of the paper", Align::kLeft},
                        {"drawn for", Align::kLeft},
                        {"by itself of", Align::kLeft},
                        {"what it shows", Align::kLeft}});
  for (const FigureEntry& entry : reports::figure_catalogue()) {
    table.add({entry.id, entry.paper, drawn_for(entry.scope), default_of(entry), entry.title});
  }
  return plain(table) +
         "\nThe paper's numbers are names too: fig2, fig3, ..., fig13. Figures 1, 6 and 7a are\n"
         "pictures: `simbench figure fig1` says where the project has what they show.\n";
}

namespace {

enum class PictureKind : std::uint8_t { kSvg, kPdf, kCsv };

PictureKind file_kind(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".svg") return PictureKind::kSvg;
  if (extension == ".pdf") return PictureKind::kPdf;
  if (extension == ".csv") return PictureKind::kCsv;
  throw InputError(
      fmt::format("--output: found '{}', allowed: a name that ends in .svg, .pdf or "
                  ".csv",
                  output));
}

// The pipelines to run: all, or one for a figure of one pipeline. `known`: those that there are.
std::vector<std::string> chosen_pipelines(const FigureCommand& command, const FigureEntry& entry,
                                          const std::vector<std::string>& known) {
  if (app::is_of_one_pipeline(entry) && command.pipelines.size() > 1) {
    throw InputError(
        fmt::format("--pipelines: found {} names, allowed: one, because {} shows one "
                    "pipeline",
                    command.pipelines.size(), entry.id));
  }
  return command.pipelines.empty() ? app::usual_pipelines(entry, known) : command.pipelines;
}

app::FigureOptions options_of(const FigureCommand& command, const FigureEntry& entry,
                              const std::vector<std::string>& known) {
  app::FigureOptions options;
  if (command.seed) options.seeds = {*command.seed};
  options.pipelines = chosen_pipelines(command, entry, known);
  options.budget_seeds = command.seeds;
  options.figures = {command.name};
  options.all_sync_modes = command.pipelines.empty();
  return options;
}

// A budget takes minutes, so its work is stated before it begins.
void announce_budget(const FigureEntry& entry, const app::FigureOptions& options,
                     std::uint64_t first_seed) {
  if (entry.scope != FigureScope::kPipeline) return;
  print_note(fmt::format("{} runs {}, each of them {} times with other parts ideal (--seeds)",
                         entry.id, reports::counted_seeds(first_seed, options.budget_seeds),
                         evaluation::kBudgetRuns));
}

std::optional<app::ArchiveFigures> make_of_scenario(const FigureCommand& command,
                                                    const FigureEntry& entry) {
  const std::string name = command.scenario.empty()
                               ? reports::scenario_of_figure(entry, command.name)
                               : command.scenario;
  const scenarios::Scenario scenario = scenarios::load_scenario(
      name, evaluation::with_ad_hoc_pipelines(name, overrides_of(command.sets), command.pipelines));
  evaluation::check_pipelines(scenario);
  print_warnings(scenarios::warnings(scenario));
  const std::vector<std::string> known = collected(scenario.pipelines, &scenarios::Pipeline::name);
  const app::FigureOptions options = options_of(command, entry, known);
  announce_budget(entry, options, command.seed.value_or(1));
  return watched<app::ArchiveFigures>([&](const evaluation::Progress& progress) {
    return app::scenario_figures(scenario, options, command.seeds, progress);
  });
}

std::optional<app::ArchiveFigures> make_of_archive(const FigureCommand& command,
                                                   const FigureEntry& entry) {
  if (command.inputs.size() > 1) {
    throw InputError(
        fmt::format("{}: found {} folders, allowed: one archive, or files of one recording",
                    command.inputs[1], command.inputs.size()));
  }
  reports::Archive archive = reports::read_archive(command.inputs.front());
  const std::vector<std::string> known =
      collected(archive.results.rows, &evaluation::Row::pipeline);
  const app::FigureOptions options = options_of(command, entry, known);
  announce_budget(entry, options, command.seed.value_or(archive.results.first_seed));
  return watched<app::ArchiveFigures>([&](const evaluation::Progress& progress) {
    return app::archive_figures(archive, options, progress);
  });
}

std::optional<app::ArchiveFigures> make_of_recording(const FigureCommand& command,
                                                     const FigureEntry& entry) {
  if (entry.scope == FigureScope::kPipeline) {
    throw InputError(
        fmt::format("{}: found a recording, allowed: --scenario or the folder of "
                    "`simbench run --output`, because {} needs other worlds",
                    command.inputs.front(), entry.id));
  }
  const app::RecordedRun run = app::recorded_run(command.inputs, file_options(command.reading),
                                                 {.pipelines = command.pipelines});
  const app::FigureOptions options = options_of(command, entry, run.chosen({}));
  return watched<app::ArchiveFigures>([&](const evaluation::Progress& progress) {
    return app::recording_figures(run, options, progress);
  });
}

// What the stamps of a rig show, of which nothing else is known.
std::optional<app::ArchiveFigures> make_of_stamps(const FigureCommand& command) {
  const auto rig = read_inputs(command.inputs, command.reading);
  if (!rig) return std::nullopt;
  return app::ArchiveFigures{
      .figures = {reports::diagnose_figure(evaluation::diagnose(rig->streams, {}))}, .notes = {}};
}

std::optional<app::ArchiveFigures> make_figures(const FigureCommand& command,
                                                const FigureEntry& entry) {
  if (entry.scope == FigureScope::kRecording) return make_of_stamps(command);
  if (command.inputs.empty()) return make_of_scenario(command, entry);
  if (app::is_recording(command.inputs.front())) return make_of_recording(command, entry);
  return make_of_archive(command, entry);
}

// The requested one of the made figures: of the named pipeline, if one is named.
const Figure& meant(const FigureCommand& command, const app::ArchiveFigures& made) {
  const std::string pipeline = command.pipelines.size() == 1 ? command.pipelines.front() : "";
  for (const Figure& figure : made.figures) {
    if (!pipeline.empty() && figure.pipeline == pipeline) return figure;
  }
  if (!made.figures.empty()) return made.figures.front();
  throw InputError(fmt::format("{}: cannot be drawn: {}", command.name,
                               made.notes.empty() ? "there is no run" : made.notes.front()));
}

// A number of the paper stands for all of its figure, which a recording must then have.
void check_is_whole(const FigureCommand& command, const Figure& figure) {
  for (const reports::FigureLack& lack : figure.lacks) {
    if (lack.was_recorded) continue;
    throw InputError(fmt::format(
        "{}: found no {} in {}, allowed: a recording that has them, as `simbench record "
        "--scenario {} -o DIR` makes it; {} draws what there is",
        command.name, lack.what, command.inputs.front(), lack.scenario, figure.id));
  }
}

int draw_figure(const FigureCommand& command) {
  if (command.list) {
    print_result(figure_list());
    return kOk;
  }
  const FigureEntry& entry = reports::figure_named(command.name);
  const PictureKind kind = file_kind(command.output);
  reports::OutputFile file(command.output);
  const std::optional<app::ArchiveFigures> made = make_figures(command, entry);
  if (!made) return kInterrupted;
  print_warnings(made->notes);
  const Figure& figure = meant(command, *made);
  if (!figure.absent.empty()) {
    throw InputError(fmt::format("{}: cannot be drawn: {}", command.name, figure.absent));
  }
  if (!command.inputs.empty() && command.name != entry.id) check_is_whole(command, figure);
  if (kind == PictureKind::kCsv) {
    file.write(reports::figure_csv(figure));
    file.publish();
  } else {
    reports::draw(figure,
                  kind == PictureKind::kSvg ? reports::PlotFormat::kSvg : reports::PlotFormat::kPdf,
                  command.output);
  }
  print_note(fmt::format("{} written: {}. {}", command.output,
                         fmt::join(reports::source_lines(figure.source), "; "), figure.caption));
  return kOk;
}

// Checks which options go together.
void check(const FigureCommand& command) {
  if (command.list) return;
  if (command.name.empty()) {
    refuse("FIGURE", "is missing; `simbench figure --list` names the figures");
  }
  if (!command.inputs.empty() && !command.scenario.empty()) {
    refuse("ARCHIVE, --scenario", "one of them is allowed, and not both");
  }
  const FigureEntry& entry = reports::figure_named(command.name);
  if (command.inputs.empty() && command.scenario.empty() && entry.scenario.empty()) {
    refuse("ARCHIVE", fmt::format("is missing: {} is of a recording, as `simbench record` makes it",
                                  entry.id));
  }
  if (!command.inputs.empty() && !command.sets.empty()) {
    refuse("--set", "allowed only for a scenario: an archive has its own parameters");
  }
  if (!command.scenario.empty() && entry.scope == FigureScope::kRecording) {
    refuse("--scenario", fmt::format("allowed only for figures of simulated runs; {} is of a "
                                     "recording: `simbench record` makes one",
                                     command.name));
  }
  if (command.output.empty()) {
    refuse("--output", "is missing: FILE.svg, FILE.pdf or FILE.csv");
  }
}

}  // namespace

void add_figure_command(CommandLine& line) {
  auto options = std::make_shared<FigureCommand>();
  Command command(line, "figure", "Draw one figure as SVG, PDF or CSV");
  command.text("name", "FIGURE", options->name,
               "The figure's name (see --list), or the paper's number as fig8");
  command.texts(
      "archive", "ARCHIVE...", options->inputs,
      "Folder that `simbench run --output` wrote; or a recording: the folder of `simbench\n"
      "record`, bags, CSV or IBL files");
  add_input_options(command, options->reading);
  command.flag("--list", options->list, "List the figures");
  command.text("--scenario", "SCENARIO", options->scenario,
               "Instead of ARCHIVE: name of a scenario or path of a scenario file. Default: the\n"
               "one that has what the paper's figure shows (--list)");
  command.sets(options->sets);
  command.seed("--seed", options->seed,
               "The seed of a figure of one seed. Default: the archive's first; 1 for a scenario");
  command.count("--seeds", options->seeds,
                "How many seeds, for figures over a scenario's seeds and for budgets. Default: 32");
  command.list("--pipelines", "PIPELINE,...", options->pipelines,
               "Only these. Default: all; for a figure of one pipeline the paper's, else\n"
               "yoon2021_both, else the first");
  command.output("-o,--output", "FILE", options->output,
                 "The file; its ending chooses .svg, .pdf or .csv. Replaces an earlier file");
  command.json_messages();
  command.footer(kFigureExamples);
  command.runs([options] { return draw_figure(*options); }, [options] { check(*options); });
}

}  // namespace simbench::cli
