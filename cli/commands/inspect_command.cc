#include <memory>
#include <string>
#include <vector>

#include "app/inspection.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "reports/recordings/inspect_report.h"

namespace simbench::cli {
namespace {

constexpr const char* kInspectExamples = R"(
Says what a recording has: for each stream of a camera its rate and gaps, which stamps were found
and which clock they are of, what became of its frames, and the drift, periods and delays of its
clock; for a bag also its topics, whether it was closed properly, and what was lost to damage. Files
are known by their content.

Examples:
  simbench inspect rig.bag
  simbench inspect rosbag2_2026_11_25/             a folder of rosbag2
  simbench inspect *.mcap --format json
  simbench inspect front.csv --device-times hull_300,raw_arrival
  simbench inspect log.csv --columns sensor=t_camera:us,arrival=t_host:s

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct InspectOptions {
  std::vector<std::string> files;
  std::vector<std::string> device_times;
  InputOptions inputs;
  std::string format;
};

int run_inspect(const InspectOptions& options) {
  const bags::FileOptions files = file_options(options.inputs);
  const auto found =
      watched_reading<std::vector<reports::Inspection>>([&](const ReadProgress& progress) {
        return app::inspected(options.files, files, options.device_times, progress);
      });
  if (!found) return kInterrupted;
  print_result(options.format == "json"
                   ? reports::inspect_json(*found)
                   : plain(reports::inspect_document(*found, reading_words(options.inputs))));
  return kOk;
}

}  // namespace

void add_inspect_command(CommandLine& line) {
  auto options = std::make_shared<InspectOptions>();
  Command command(line, "inspect", "Say what a bag or another recording has: topics, stamps, gaps");
  command.texts("inputs", "INPUT...", options->files, kInputsText).required();
  command.format(options->format, {"table", "json"});
  command.list("--device-times", "NAME,...", options->device_times,
               "Also the jitter, residual and drift of the stamps by these device_times");
  add_input_options(command, options->inputs);
  command.footer(kInspectExamples);
  command.runs([options] { return run_inspect(*options); });
}

}  // namespace simbench::cli
