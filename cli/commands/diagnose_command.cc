#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands/commands.h"
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

Exit status: 0 ok, for any diagnosis, 1 internal error, 2 bad usage or input.)";

struct DiagnoseOptions {
  std::vector<std::string> files;
  std::string format;
  std::optional<double> rate_hz;
  bool one_host = false;
};

int run_diagnose(const DiagnoseOptions& options) {
  const CsvRecordings recordings = read_recordings(options.files);
  for (const std::string& note : recordings.notes) print_note(note);
  const evaluation::Diagnosis diagnosis = evaluation::diagnose(
      recordings.streams, {.rate_hz = options.rate_hz, .one_host = options.one_host});
  print_result(options.format == "json" ? reports::diagnose_json(diagnosis, options.files)
                                        : reports::diagnose_table(diagnosis));
  return kOk;
}

}  // namespace

void add_diagnose_command(CommandLine& line) {
  auto options = std::make_shared<DiagnoseOptions>();
  Command command(line, "diagnose", "Find out whether the hardware sync of a recorded rig works");
  command.texts("files", "FILE.csv...", options->files, "CSV recordings").required();
  command.format(options->format, {"table", "json"});
  command.number("--rate-hz", "HZ", options->rate_hz, kLowestRateHz, kHighestRateHz,
                 "The trigger's rate. Default: the rate of most cameras");
  command.flag("--one-host", options->one_host,
               "One computer stamped all arrivals, even if the files name several hosts");
  command.footer(kDiagnoseExamples);
  command.runs([options] { return run_diagnose(*options); });
}

}  // namespace simbench::cli
