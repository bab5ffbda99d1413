#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/recorded_streams.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/progress.h"
#include "reports/rigs/inspect_report.h"

namespace simbench::cli {
namespace {

constexpr const char* kInspectExamples = R"(
Says in one screen what a recording has: for each stream of a camera its frames, rate, lost frames
and gaps, which stamps were found and which clock they are of; for a bag also its topics, whether it
was closed properly, and what was lost to damage. Files are known by their content.

Examples:
  simbench inspect rig.bag
  simbench inspect rosbag2_2026_11_25/             a folder of rosbag2
  simbench inspect *.mcap --format json
  simbench inspect log.csv --columns sensor=t_camera:us,arrival=t_host:s

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct InspectOptions {
  std::vector<std::string> files;
  InputOptions inputs;
  std::string format;
};

reports::Inspection inspected(const std::string& path, const bags::FileOptions& options,
                              const ReadProgress& progress) {
  reports::Inspection found{.file = path};
  if (!std::filesystem::exists(path) || !bags::is_bag(path)) {
    found.recording = app::recorded_streams({path}, options, progress);
    return found;
  }
  found.bag = bags::scan_recording(path, camera_names({path}).front(),
                                   {.topics = options.topics, .all_topics = true}, progress);
  found.recording = {std::move(found.bag->streams), std::move(found.bag->notes)};
  return found;
}

int run_inspect(const InspectOptions& options) {
  const bags::FileOptions files = file_options(options.inputs);
  const auto found = watched<std::vector<reports::Inspection>>(
      [&](const evaluation::Progress& progress) {
        std::vector<reports::Inspection> all;
        for (const std::string& file : options.files) {
          all.push_back(inspected(file, files, progress));
        }
        return all;
      },
      {.unit = "megabyte"});
  if (!found) return kInterrupted;
  print_result(options.format == "json" ? reports::inspect_json(*found)
                                        : plain(reports::inspect_document(*found)));
  return kOk;
}

}  // namespace

void add_inspect_command(CommandLine& line) {
  auto options = std::make_shared<InspectOptions>();
  Command command(line, "inspect", "Say what a bag or another recording has: topics, stamps, gaps");
  command.texts("inputs", "INPUT...", options->files, kInputsText).required();
  command.format(options->format, {"table", "json"});
  add_input_options(command, options->inputs);
  command.footer(kInspectExamples);
  command.runs([options] { return run_inspect(*options); });
}

}  // namespace simbench::cli
