
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/recorded_streams.h"
#include "app/recordings.h"
#include "app/results.h"
#include "app/results_text.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/progress.h"
#include "evaluation/replay/replay.h"
#include "recording/recording.h"
#include "reports/archive/archive.h"
#include "reports/results/results_answer.h"
#include "reports/rigs/replay_report.h"

namespace simbench::cli {
namespace {

constexpr const char* kReplayExamples = R"(
Takes a folder that `simbench record` wrote, and prints the table of the recorded run. It scores
what it finds of a recording that was cut off or is damaged, and notes that.

Or takes files of real cameras, by their content: bags of the RealSense SDK, of ROS 1 and of ROS 2
(MCAP, SQLite, a folder of them), and the CSV of librealsense's rs-data-collect:
  Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)
one file per camera, or one file of several cameras with two more columns, `camera` and `host`;
--columns reads other CSV. Arrivals of several cameras must count from one instant. It runs
device_time and gathering on these files; host_sync cannot be replayed.

Examples:
  simbench replay monday                            a recording folder
  simbench replay monday --pipelines genlock --format markdown
  simbench replay front.bag back.bag
  simbench replay front.csv
  simbench replay front.csv back.csv --format json > replay.json
  simbench replay rig.csv --output results/rig      frames.csv: a line per frame, with global stamps

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct ReplayOptions {
  std::vector<std::string> files;
  InputOptions inputs;
  std::vector<std::string> pipelines;
  std::string format;
  std::string output;
  std::vector<std::string> command;
};

std::string replay_text(const evaluation::Replay& replay, const ReplayOptions& options) {
  if (options.format == "json") return reports::replay_json(replay, options.files);
  if (options.format == "csv") return reports::replay_csv(replay);
  return reports::replay_table(replay);
}

// Refuses options that need a recording folder.
void check_options_for_files(const ReplayOptions& options) {
  if (options.format == "markdown") {
    throw scenarios::InputError("--format: found 'markdown', allowed with files: table, json, csv");
  }
  if (!options.pipelines.empty()) {
    throw scenarios::InputError("--pipelines: only a recording folder has pipelines");
  }
}

void end_if_interrupted() {
  if (app::InterruptHandler::raised()) throw RecordingCancelled();
}

// Nothing after Ctrl-C.
std::optional<evaluation::Replay> replay_files(std::vector<CameraStream> streams) {
  return watched<evaluation::Replay>(
      [&](const evaluation::Progress& progress) {
        return evaluation::run_replay(std::move(streams),
                                      [&](std::uint64_t done, std::uint64_t total) {
                                        progress(done, total);
                                        end_if_interrupted();
                                      });
      },
      {.unit = "stamp"});
}

int run_files(const ReplayOptions& options) {
  check_options_for_files(options);
  reports::Provenance provenance;
  provenance.command = options.command;
  provenance.started = std::chrono::system_clock::now();
  std::unique_ptr<reports::OutputFolder> output;
  if (!options.output.empty()) output = std::make_unique<reports::OutputFolder>(options.output);
  auto recordings = read_inputs(options.files, options.inputs);
  if (!recordings) return kInterrupted;
  const auto replayed = replay_files(std::move(recordings->streams));
  if (!replayed) return kInterrupted;
  const evaluation::Replay& replay = *replayed;
  print_warnings(replay.warnings);
  print_note("host_sync cannot be replayed; only device_time and gathering were run");
  provenance.finished = std::chrono::system_clock::now();
  if (output) {
    output->file("manifest.json") << reports::manifest_json(provenance, {{"files", options.files}});
    output->file("results.json") << reports::replay_json(replay, options.files);
    reports::write_replay_frames(replay, output->file("frames.csv"));
    output->publish();
    print_note("results written to " + options.output);
  }
  print_result(replay_text(replay, options));
  return kOk;
}

int run_folder(const std::string& folder, const ReplayOptions& options) {
  app::RunArchive archive(options.command);
  const app::RecordedRun run(folder);
  const std::vector<std::string> pipelines = run.chosen(options.pipelines);
  for (const std::string& note : run.missing()) print_note(note);
  archive.open(options.output);
  const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
    return run.evaluate(pipelines, !options.output.empty(), progress);
  });
  if (!results) return kInterrupted;
  print_warnings(results->warnings);
  for (const std::string& note : app::capture_notes(*results)) print_note(note);
  if (archive.write(*results, run.scenario())) {
    print_note("results written to " + options.output);
  }
  print_result(app::results_text(
      *results, run.scenario(), options.format, app::Detail::kAll,
      reports::results_answer(*results, app::ranked_by(run.scenario()), nullptr)));
  return kOk;
}

int run_replay(const ReplayOptions& options) {
  const std::optional<std::string> folder = app::recording_folder_of(options.files);
  return folder ? run_folder(*folder, options) : run_files(options);
}

}  // namespace

void add_replay_command(CommandLine& line) {
  auto options = std::make_shared<ReplayOptions>();
  options->command = line.arguments;
  Command command(
      line, "replay",
      "Score a recording folder, or device_time and gathering on files of real cameras");
  command.texts("recordings", "INPUT...", options->files, kInputsText).required();
  add_input_options(command, options->inputs);
  command.list("--pipelines", "PIPELINE,...", options->pipelines,
               "With a folder: only these of the recorded pipelines, in this order");
  command.format(options->format, {"table", "markdown", "json", "csv"});
  command.text("-o,--output", "DIR", options->output,
               "Write manifest.json, results.json and frames.csv (for a recording folder also\n"
               "hosts.csv) to this folder. Replaces an earlier result there");
  command.footer(kReplayExamples);
  command.runs([options] { return run_replay(*options); });
}

}  // namespace simbench::cli
