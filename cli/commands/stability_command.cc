#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "evaluation/stability/log_stability.h"
#include "reports/stability/stability_report.h"

namespace simbench::cli {
namespace {

constexpr double kShortestIntervalS = 1e-6;
constexpr double kLongestIntervalS = 1e9;

constexpr const char* kStabilityExamples = R"(
Takes what other programs have measured, and recognises it by content: CSV (seconds, time error),
tracking.log and statistics.log of chrony, the output of ptp4l and phc2sys, loopstats of ntpd. Gives
Allan, modified Allan, Hadamard and time deviation, MTIE and the size of the time error, over
octaves of tau. Gaps are kept apart, never interpolated; steps are named.

Examples:
  simbench stability /var/log/chrony/tracking.log
  simbench stability ptp4l.txt phc2sys.txt --remove-frequency
  simbench stability errors.csv --unit ns --format json > stability.json
  simbench stability statistics.log --series 203.0.113.15

Exit status: 0 ok, 1 internal error, 2 bad usage or input.)";

struct StabilityOptions {
  std::vector<std::string> files;
  std::string format;
  std::string unit;
  std::string series;
  evaluation::LogStabilityOptions stability;
};

std::optional<evaluation::ErrorUnit> unit_named(const std::string& name) {
  if (name == "s") return evaluation::ErrorUnit::kS;
  if (name == "ms") return evaluation::ErrorUnit::kMs;
  if (name == "us") return evaluation::ErrorUnit::kUs;
  if (name == "ns") return evaluation::ErrorUnit::kNs;
  return std::nullopt;
}

int run_stability(const StabilityOptions& options) {
  std::vector<evaluation::LogStability> found;
  for (const std::string& file : options.files) {
    const evaluation::ClockLog log = evaluation::read_clock_log(
        file, {.unit = unit_named(options.unit), .series = options.series});
    found.push_back(evaluation::stability_of_log(log, options.stability));
  }
  for (const evaluation::LogStability& file : found) {
    for (const std::string& note : file.notes) print_note(note);
  }
  print_result(options.format == "json" ? reports::stability_json(found)
               : options.format == "csv"
                   ? reports::stability_csv(found)
                   : reports::drawn_as(options.format, reports::stability_document(found)));
  return kOk;
}

}  // namespace

void add_stability_command(CommandLine& line) {
  auto options = std::make_shared<StabilityOptions>();
  Command command(line, "stability",
                  "How stable a measured clock is: ADEV, TDEV, MTIE, time error");
  command.texts("files", "FILE...", options->files, "Logs of clocks, one clock each").required();
  command.word("--unit", "UNIT", options->unit, {"s", "ms", "us", "ns"},
               "Unit of the time errors of CSV files. Default: what the column's name ends in "
               "(error_ms), else s");
  command.text("--series", "NAME", options->series,
               "Which series of a file that has several: a column of a CSV (or its number), a "
               "source of\nstatistics.log, a port of ptp4l, a clock of phc2sys");
  command.number("--interval-s", "SECONDS", options->stability.interval_s, kShortestIntervalS,
                 kLongestIntervalS, "The distance of points. Default: the median of the file");
  command.flag("--remove-frequency", options->stability.remove_frequency,
               "Remove the frequency offset (a least-squares line) before anything else");
  command.format(options->format, {"table", "markdown", "csv", "json"});
  command.footer(kStabilityExamples);
  command.runs([options] { return run_stability(*options); });
}

}  // namespace simbench::cli
