
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/answer.h"
#include "app/recorded_streams.h"
#include "app/recordings.h"
#include "app/results.h"
#include "app/results_text.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/progress.h"
#include "reports/recordings/stream_blocks.h"
#include "reports/results/results_answer.h"

namespace simbench::cli {
namespace {

constexpr const char* kReplayExamples = R"(
Takes a folder that `simbench record` wrote, and prints the table of the recorded run. It scores
what it finds of a recording that was cut off or is damaged, and notes that.

Or takes files of real cameras, by their content: bags of the RealSense SDK, of ROS 1 and of ROS 2
(MCAP, SQLite, a folder of them), IBL's files, and the CSV of librealsense's rs-data-collect:
  Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)
one file per camera, or one file of several cameras with two more columns, `camera` and `host`;
--columns reads other CSV. Arrivals of several cameras must count from one instant. A pipeline of
files is device_time[+gathering], since host_sync cannot be run again; without a choice each
device_time that needs stamps alone, with yoon2021.

Examples:
  simbench replay monday                            a recording folder
  simbench replay monday --pipelines genlock --format markdown
  simbench replay front.bag back.bag
  simbench replay a.bag b.bag --pipelines hull_300,hull_300+genlock --format markdown
  simbench replay rig.csv --output results/rig      an archive for report, compare and gate

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct ReplayOptions {
  std::vector<std::string> inputs;
  InputOptions reading;
  app::StreamScoring scoring;
  std::string rank_by;
  std::string format;
  std::string output;
  bool certify = false;
  std::vector<std::string> command;
};

// Nothing after Ctrl-C.
std::optional<app::RecordedRun> recorded_run(const ReplayOptions& options) {
  std::optional<app::RecordedRun> run;
  if (app::recording_folder_of(options.inputs)) {
    run.emplace(app::recorded_run(options.inputs, {}, options.scoring));
  } else if (auto recorded = read_inputs(options.inputs, options.reading)) {
    run.emplace(options.inputs, std::move(*recorded), options.scoring);
  }
  return run;
}

void print_notes(const app::RecordedRun& run, const evaluation::Results& results) {
  print_warnings(results.warnings);
  for (const std::string& note : app::capture_notes(results)) print_note(note);
  if (run.streams() == nullptr) return;
  for (const std::string& note : run.streams()->notes()) print_note(note);
  print_note("host_sync cannot be replayed; only device_time and gathering were run");
}

int run_replay(const ReplayOptions& options) {
  if (options.certify) app::check_evidence(options.inputs);
  app::RunArchive archive(options.command);
  archive.open(options.output);
  const std::optional<app::RecordedRun> run = recorded_run(options);
  if (!run) return kInterrupted;
  const std::vector<std::string> pipelines = run->chosen(options.scoring.pipelines);
  for (const std::string& note : run->missing()) print_note(note);
  auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
    return run->evaluate(
        pipelines, {.keep_pulses = !options.output.empty(), .certify = options.certify}, progress);
  });
  if (!results) return kInterrupted;
  app::rank_by(options.rank_by, *results);
  print_notes(*run, *results);
  if (archive.write(*results, run->scenario())) {
    print_note("results written to " + options.output);
  }
  std::vector<reports::Block> more;
  if (run->streams() != nullptr) more.push_back(reports::frames_block(run->streams()->streams()));
  print_result(app::results_text(*results, run->scenario(), options.format, app::Detail::kAll,
                                 reports::results_answer(*results), more));
  return kOk;
}

}  // namespace

void add_replay_command(CommandLine& line) {
  auto options = std::make_shared<ReplayOptions>();
  options->command = line.arguments;
  Command command(line, "replay",
                  "Score a recording: a folder of `simbench record`, or files of real cameras");
  command.texts("recordings", "INPUT...", options->inputs, kInputsText).required();
  add_input_options(command, options->reading);
  command.list("--pipelines", "PIPELINE,...", options->scoring.pipelines,
               "With a folder: only these of the recorded pipelines, in this order. With files:\n"
               "these, as device_time[+gathering]");
  command.text("--stream", "NAME", options->scoring.stream,
               "With files: score this kind of stream. Default: the one that most cameras have");
  command.flag("--genlock", options->scoring.genlock,
               "With files: one trigger pulse started all cameras (GenLock), so that the order of\n"
               "frames tells which belong together. Default: the gathered sets are scored,\n"
               "unverified");
  command.flag(
      "--certify", options->certify,
      "A column beside AMD: no two frames of 95 % of the sets were exposed further apart,\n"
      "for sure; `simbench certify` says what limits it");
  command.rank_by(options->rank_by);
  command.format(options->format, {"table", "markdown", "latex", "json", "csv", "tidy"});
  command.output("-o,--output", "DIR", options->output,
                 "Write manifest.json, results.json, frames.csv and hosts.csv to this folder, as\n"
                 "`simbench run` does. Replaces an earlier result there");
  command.footer(kReplayExamples);
  command.runs([options] { return run_replay(*options); });
}

}  // namespace simbench::cli
