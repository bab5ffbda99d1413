#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/registry.h"
#include "app/stream_run.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "evaluation/frames/gathered_sets.h"
#include "recording/counted.h"
#include "reports/recordings/sets_csv.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr const char* kExportExamples = R"(
Finds the frames that belong together and writes where they are: a CSV line a frame with set,
camera, stream, file, topic, number of the message in its topic, counter, sensor stamp, arrival and
global stamp (all in ns). A program that reads the bags takes the matched frames out by topic and
message. With --stamps it writes every frame with its global stamps by the named device_times.

Examples:
  simbench export front.bag back.bag -o sets.csv
  simbench export rig.mcap --gathering approximate_time --complete > sets.csv
  simbench export *.bag --device-time two_way_hull --stream "Color 0" -o colour.csv
  simbench export rig.csv --stamps hull_300,raw_arrival -o frames.csv

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct ExportOptions {
  std::vector<std::string> files;
  InputOptions inputs;
  std::string device_time = "regression_30";
  std::string gathering = "yoon2021";
  std::string stream;
  std::vector<std::string> stamps;
  bool complete = false;
  std::string output;
};

void check_known(const std::vector<std::string>& known, const char* option,
                 const std::string& name) {
  if (std::ranges::find(known, name) != known.end()) return;
  throw scenarios::InputError(
      fmt::format("{}: found '{}', allowed {}", option, name, fmt::join(known, ", ")));
}

void check_algorithms(const ExportOptions& options) {
  check_known(app::device_times_of_stamps(), "--device-time", options.device_time);
  std::vector<std::string> gatherings;
  for (const GatheringEntry& entry : algorithms<GatheringEntry>()) {
    if (entry.info.needs.empty()) gatherings.push_back(entry.info.name);
  }
  check_known(gatherings, "--gathering", options.gathering);
}

void write_sets(const ExportOptions& options, RecordedStreams recorded, std::ostream& out) {
  const app::StreamRun run(
      std::move(recorded), options.files,
      {.pipelines = {options.device_time + "+" + options.gathering}, .stream = options.stream});
  const std::unique_ptr<evaluation::StreamSource> source = run.source();
  if (source->streams().size() < 2) {
    throw scenarios::InputError(fmt::format(
        "found one camera with a stream {}, allowed two or more to gather", run.kind()));
  }
  evaluation::GatheredSets found = evaluation::gathered_sets(
      run.scenario(), evaluation::choose_pipelines(run.scenario(), {}).front(), *source);
  if (options.complete) {
    std::erase_if(found.sets, [](const evaluation::GatheredSet& set) { return !set.complete; });
  }
  reports::write_sets_csv(found.sets, source->streams(), out);
  print_note(fmt::format("{} of {} by {} and {}, {} in no set", counted(found.sets.size(), "set"),
                         run.kind(), options.device_time, options.gathering,
                         counted(static_cast<std::uint64_t>(found.discarded), "frame")));
}

int run_export(const ExportOptions& options) {
  std::optional<reports::OutputFile> file;
  if (!options.output.empty()) file.emplace(options.output);
  check_algorithms(options);
  auto rig = read_inputs(options.files, options.inputs);
  if (!rig) return kInterrupted;
  std::ostringstream text;
  if (options.stamps.empty()) {
    write_sets(options, std::move(*rig), text);
  } else {
    reports::write_stamps_csv(app::stamped_streams(rig->streams, options.stamps, "--stamps"), text);
  }
  if (!file) {
    print_result(text.str());
    return kOk;
  }
  file->write(text.str());
  file->publish();
  return kOk;
}

}  // namespace

void add_export_command(CommandLine& line) {
  auto options = std::make_shared<ExportOptions>();
  Command command(line, "export", "Write which frames belong together: file, topic, message");
  command.texts("inputs", "INPUT...", options->files, kInputsText).required();
  command.text("--device-time", "NAME", options->device_time,
               "Stamps the frames. Default: regression_30");
  command.text("--gathering", "NAME", options->gathering, "Finds the sets. Default: yoon2021");
  command.text("--stream", "NAME", options->stream,
               "Of this kind of stream. Default: the one that most cameras have");
  command.flag("--complete", options->complete, "Only sets in which no camera is missing");
  command.list("--stamps", "NAME,...", options->stamps,
               "In place of sets: every frame, with its global stamps by these device_times");
  add_input_options(command, options->inputs);
  command.output("-o,--output", "FILE.csv", options->output,
                 "The file to write. Default: standard output. Replaces an earlier file");
  command.footer(kExportExamples);
  command.runs([options] { return run_export(*options); });
}

}  // namespace simbench::cli
