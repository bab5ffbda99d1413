#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "evaluation/replay/gathered_sets.h"
#include "recording/counted.h"
#include "reports/rigs/sets_csv.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr const char* kExportExamples = R"(
Finds the frames that belong together and writes where they are: a CSV line a frame with set,
camera, stream, file, topic, number of the message in its topic, counter, sensor stamp, arrival and
global stamp (all in ns). A program that reads the bags takes the matched frames out by topic and
message.

Examples:
  simbench export front.bag back.bag -o sets.csv
  simbench export rig.mcap --gathering approximate_time --complete > sets.csv
  simbench export *.bag --device-time two_way_hull --stream "Color 0" -o colour.csv

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct ExportOptions {
  std::vector<std::string> files;
  InputOptions inputs;
  std::string device_time = "regression_30";
  std::string gathering = "yoon2021";
  std::string stream;
  bool complete = false;
  std::string output;
};

// The entry of this name, among those that run on recordings.
template <class Entry>
const Entry& chosen_entry(const std::vector<Entry>& entries, const std::string& option,
                          const std::string& name) {
  std::vector<std::string> known;
  for (const Entry& entry : entries) {
    if (!entry.make || !evaluation::runs_on_recordings(entry.info)) continue;
    if (entry.info.name == name) return entry;
    known.push_back(entry.info.name);
  }
  throw scenarios::InputError(
      fmt::format("{}: found '{}', allowed {}", option, name, fmt::join(known, ", ")));
}

// The kind of stream that the most cameras have; of equal ones the first.
std::string chosen_stream(const std::vector<CameraStream>& streams, const std::string& wanted) {
  std::vector<std::string> kinds;
  for (const CameraStream& stream : streams) {
    if (std::ranges::find(kinds, stream.stream) == kinds.end()) kinds.push_back(stream.stream);
  }
  const auto cameras = [&streams](const std::string& kind) {
    return std::ranges::count(streams, kind, &CameraStream::stream);
  };
  if (wanted.empty()) {
    return *std::ranges::max_element(kinds, {}, cameras);
  }
  if (std::ranges::find(kinds, wanted) != kinds.end()) return wanted;
  throw scenarios::InputError(
      fmt::format("--stream: found '{}', allowed {}", wanted, fmt::join(kinds, ", ")));
}

int run_export(const ExportOptions& options) {
  std::optional<reports::OutputFile> file;
  if (!options.output.empty()) file.emplace(options.output);
  const DeviceTimeEntry& device_time =
      chosen_entry(algorithms<DeviceTimeEntry>(), "--device-time", options.device_time);
  const GatheringEntry& gathering =
      chosen_entry(algorithms<GatheringEntry>(), "--gathering", options.gathering);
  const auto rig = read_inputs(options.files, options.inputs);
  if (!rig) return kInterrupted;
  const std::string kind = chosen_stream(rig->streams, options.stream);
  if (std::ranges::count(rig->streams, kind, &CameraStream::stream) < 2) {
    throw scenarios::InputError(
        fmt::format("found one camera with a stream {}, allowed two or more to gather", kind));
  }
  evaluation::GatheredSets found =
      evaluation::gathered_sets(rig->streams, kind, device_time, gathering);
  if (options.complete) {
    std::erase_if(found.sets, [](const evaluation::GatheredSet& set) { return !set.complete; });
  }
  std::ostringstream text;
  reports::write_sets_csv(found.sets, rig->streams, text);
  print_note(fmt::format("{} of {} by {} and {}, {} in no set", counted(found.sets.size(), "set"),
                         kind, options.device_time, options.gathering,
                         counted(found.discarded, "frame")));
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
  add_input_options(command, options->inputs);
  command.text("-o,--output", "FILE.csv", options->output,
               "The file to write. Default: standard output. Replaces an earlier file");
  command.footer(kExportExamples);
  command.runs([options] { return run_export(*options); });
}

}  // namespace simbench::cli
