#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/trigger_code.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "reports/text/output_file.h"
#include "reports/trigger_code/code_header.h"
#include "reports/trigger_code/code_report.h"

namespace simbench::cli {
namespace {

constexpr const char* kCodeExamples = R"(
Says what a scenario's coded trigger is, how soon a camera finds its place in it, and what each
sync mode of the cameras makes of it. With --export it also writes the intervals for a
microcontroller's timer.

Examples:
  simbench code 18cam_6host_90fps_coded
  simbench code 18cam_6host_90fps_coded --export intervals.h
  simbench code 18cam_6host_90fps_coded --set /trigger/code/order=14
  simbench code my_rig.json --export intervals.h --timer-hz 16000000)";

struct CodeOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::string header;
  double timer_hz = 1e6;
  std::string format;
};

int show_code(const CodeOptions& options) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  std::optional<reports::OutputFile> file;
  if (!options.header.empty()) file.emplace(options.header);
  const reports::TriggerCodeResult result = app::trigger_code_of(scenario);
  std::string header;
  if (file) header = reports::code_header(result, options.timer_hz);
  print_result_in(options.format, [&result](const std::string& format) {
    return format == "json" ? reports::trigger_code_json(result)
                            : reports::drawn_as(format, reports::trigger_code_document(result));
  });
  if (file) {
    file->write(header);
    file->publish();
    print_note(options.header + " written");
  }
  return kOk;
}

}  // namespace

void add_code_command(CommandLine& line) {
  auto options = std::make_shared<CodeOptions>();
  Command command(line, "code",
                  "A coded trigger: its pulses, what cameras make of them, its table as C");
  command.text("scenario", "SCENARIO", options->scenario, "A scenario with /trigger/code")
      .required();
  command.sets(options->sets);
  const Option header =
      command.output("--export", "FILE.h", options->header, "Write the intervals as a C header");
  command
      .number("--timer-hz", "HZ", options->timer_hz, 1, 1e10,
              "Ticks a second of the timer that makes the pulses. Default: 1000000")
      .needs(header);
  command.format(options->format, {"table", "markdown", "latex", "json"});
  command.footer(kCodeExamples);
  command.runs([options] { return show_code(*options); });
}

}  // namespace simbench::cli
