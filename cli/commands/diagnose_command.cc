#include "cli/commands/diagnose_command.h"

#include <memory>
#include <optional>

#include "cli/exit_status.h"
#include "cli/recordings.h"
#include "evaluation/diagnosis/diagnose.h"
#include "reports/rigs/diagnose_report.h"

namespace simbench::cli {
namespace {

constexpr double kLowestRateHz = 0.01;
constexpr double kHighestRateHz = 10'000;

constexpr const char* kDiagnoseExamples = R"(
Takes the recordings that `simbench replay` takes: the CSV of librealsense's rs-data-collect, one
file per camera, or one of several cameras with two more columns, `camera` and `host`. A minute is
enough to tell cameras that run free from cameras that follow a trigger.

Examples:
  simbench diagnose rig.csv
  simbench diagnose front.csv back.csv --one-host      both recorded on one computer
  simbench diagnose rig.csv --rate-hz 30 --format json > diagnosis.json

Exit status: 0 ok, whatever was found, 1 internal error, 2 bad usage or input.)";

struct DiagnoseOptions {
  std::vector<std::string> files;
  std::string format;
  std::optional<double> rate_hz;
  bool one_host = false;
};

int run_diagnose(const DiagnoseOptions& options) {
  const evaluation::Diagnosis diagnosis = evaluation::diagnose(
      read_recordings(options.files), {.rate_hz = options.rate_hz, .one_host = options.one_host});
  print_result(options.format == "json" ? reports::diagnose_json(diagnosis, options.files)
                                        : reports::diagnose_table(diagnosis));
  return kOk;
}

}  // namespace

void add_diagnose_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("diagnose", "Is the hardware sync of a recorded rig working at all?");
  auto options = std::make_shared<DiagnoseOptions>();
  command->add_option("files", options->files, "Recordings")->type_name("FILE.csv...")->required();
  add_format_option(*command, options->format, {"table", "json"});
  command
      ->add_option("--rate-hz", options->rate_hz,
                   "The trigger's rate. Default: that of most cameras")
      ->type_name("HZ")
      ->check(number_within(kLowestRateHz, kHighestRateHz));
  command->add_flag("--one-host", options->one_host,
                    "One computer stamped all arrivals, whatever the files say");
  command->footer(kDiagnoseExamples);
  command->callback([options, &action] { action = [options] { return run_diagnose(*options); }; });
}

}  // namespace simbench::cli
