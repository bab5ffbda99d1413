#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/figure_file.h"
#include "evaluation/stability/log_stability.h"
#include "evaluation/stability/mask_verdict.h"
#include "reports/figures/stability_figure.h"
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
  simbench stability ptp4l.txt --mask class_b --figure ptp4l.svg
  simbench stability errors.csv --limit max_te=100ns,mtie@10s=50ns,adev@1s=1e-9,p99=80ns

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 3 a limit is not kept.)";

struct StabilityOptions {
  std::vector<std::string> files;
  std::string format;
  std::string unit;
  std::string series;
  std::string mask;
  std::vector<std::string> limits;
  std::string figure;
  evaluation::LogStabilityOptions stability;
};

std::optional<evaluation::ErrorUnit> unit_named(const std::string& name) {
  if (name == "s") return evaluation::ErrorUnit::kS;
  if (name == "ms") return evaluation::ErrorUnit::kMs;
  if (name == "us") return evaluation::ErrorUnit::kUs;
  if (name == "ns") return evaluation::ErrorUnit::kNs;
  return std::nullopt;
}

std::vector<evaluation::ClockMask> masks_of(const StabilityOptions& options) {
  std::vector<evaluation::ClockMask> masks;
  if (!options.mask.empty()) masks.push_back(evaluation::mask_named(options.mask));
  if (!options.limits.empty()) masks.push_back(evaluation::limits_mask(options.limits));
  return masks;
}

bool keeps_limits(const reports::StabilityFinding& finding) {
  return std::ranges::none_of(finding.verdicts, [](const evaluation::MaskVerdict& verdict) {
    return verdict.judgement == evaluation::Judgement::kFails;
  });
}

int run_stability(const StabilityOptions& options) {
  const FigureFile figure(options.figure);
  const std::vector<evaluation::ClockMask> masks = masks_of(options);
  std::vector<reports::StabilityFinding> found;
  for (const std::string& file : options.files) {
    const evaluation::ClockLog log = evaluation::read_clock_log(
        file, {.unit = unit_named(options.unit), .series = options.series});
    reports::StabilityFinding finding{.log = evaluation::stability_of_log(log, options.stability)};
    for (const evaluation::ClockMask& mask : masks) {
      finding.verdicts.push_back(evaluation::judge(finding.log.stability, mask));
    }
    found.push_back(std::move(finding));
  }
  for (const reports::StabilityFinding& finding : found) {
    for (const std::string& note : finding.log.notes) print_note(note);
  }
  print_result(options.format == "json" ? reports::stability_json(found)
               : options.format == "csv"
                   ? reports::stability_csv(found)
                   : reports::drawn_as(options.format, reports::stability_document(found)));
  // Last: without gnuplot the results are there all the same.
  if (figure) figure.draw(reports::stability_figure(found, masks));
  return std::ranges::all_of(found, keeps_limits) ? kOk : kGateFailed;
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
  std::vector<std::string> masks;
  for (const evaluation::ClockMask& mask : evaluation::masks()) masks.push_back(mask.id);
  command.word("--mask", "MASK", options->mask, masks,
               "Judge by the limits of ITU-T: G.8272 (prtc), G.8273.2 (class), G.813 (sec)");
  command.list("--limit", "LIMIT,...", options->limits,
               "Judge by limits of your own: max_te, cte, te_p2p, p50, p95, p99, p99.9, mtie@TAU,\n"
               "tdev@TAU with a time, adev@TAU, mdev@TAU, hdev@TAU with a number");
  command.text("--figure", "FILE", options->figure,
               "Draw ADEV, TDEV and MTIE with their intervals and limits to this file (.svg or\n"
               ".pdf, by gnuplot)");
  command.format(options->format, {"table", "markdown", "csv", "json"});
  command.footer(kStabilityExamples);
  command.runs([options] { return run_stability(*options); });
}

}  // namespace simbench::cli
