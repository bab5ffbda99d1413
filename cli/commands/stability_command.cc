#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/figure_file.h"
#include "cli/mask_options.h"
#include "evaluation/stability/log_stability.h"
#include "evaluation/stability/mask_verdict.h"
#include "recording/date_time.h"
#include "recording/number_in.h"
#include "reports/figures/stability_figure.h"
#include "reports/page/stability_page.h"
#include "reports/stability/stability_report.h"
#include "reports/text/output_file.h"

namespace simbench::cli {
namespace {

constexpr double kShortestIntervalS = 1e-6;
constexpr double kLongestIntervalS = 1e9;

constexpr const char* kStabilityExamples = R"(
Takes what other programs have measured, and recognises it by content: tables of time and time
error (CSV), and the logs of ptp4l, phc2sys, ts2phc, chrony, ntpd, sntp, ntpshmmon, w32tm,
systemd-timesyncd and ptpd, behind any head (syslog, journalctl, Docker, Kubernetes), compressed
or not; - is standard input. Gives Allan, modified Allan, Hadamard and time deviation, MTIE and
the size of the time error, over octaves of tau. Gaps are kept apart, never interpolated; steps
are named, and a start before the clock was set. docs/files.md has a command for each form.

Examples:
  simbench stability /var/log/chrony/tracking.log
  journalctl -u ptp4l | simbench stability - --locked
  simbench stability syslog --series
  simbench stability errors.csv --unit ns --format json > stability.json
  simbench stability phase.txt --tau0 1 --remove-frequency
  simbench stability ptp4l.txt --mask class_b --figure ptp4l.svg
  simbench stability ptp4l.txt --mask class_b --html ptp4l.html
  simbench stability errors.csv --limit max_te=100ns,mtie@10s=50ns,adev@1s=1e-9,p99=80ns

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 3 a limit is not kept.)";

struct StabilityOptions {
  std::vector<std::string> files;
  std::string format;
  std::string unit;
  std::string time_unit;
  std::string from;
  std::string until;
  evaluation::ClockLogOptions log;
  MaskOptions limits;
  std::string figure;
  std::string html;
  std::vector<std::string> command;
  evaluation::LogStabilityOptions stability;
};

std::optional<StampUnit> unit_of(const char* option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<StampUnit> unit = unit_named(text);
  if (!unit) refuse(option, fmt::format("found '{}', allowed: {}", text, kUnitsText));
  return unit;
}

std::optional<evaluation::LogTime> time_of(const char* option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (const auto time = date_time_in(text)) {
    return evaluation::LogTime{1e-9 * static_cast<double>(time->count()), false};
  }
  const std::optional<double> seconds = number_in<double>(text);
  if (!seconds) {
    refuse(option, fmt::format("found '{}', allowed: seconds since the first point, or a time such "
                               "as 2024-09-03T10:32:22Z",
                               text));
  }
  return evaluation::LogTime{*seconds, true};
}

void check_options(StabilityOptions& options) {
  options.log.unit = unit_of("--unit", options.unit);
  options.log.time_unit = unit_of("--time-unit", options.time_unit);
  options.log.interval_s = options.stability.interval_s;
  options.stability.from = time_of("--from", options.from);
  options.stability.until = time_of("--until", options.until);
}

int list_series(const StabilityOptions& options) {
  std::vector<reports::LogSeriesOfFile> found;
  for (const std::string& file : options.files) {
    found.push_back({file, evaluation::clock_log_series(file, options.log)});
  }
  print_result_in(options.format, [&found](const std::string& format) {
    return format == "json" || format == "csv"
               ? reports::log_series_json(found)
               : reports::drawn_as(format, reports::log_series_document(found));
  });
  return kOk;
}

bool keeps_limits(const reports::StabilityFinding& finding) {
  return std::ranges::none_of(finding.verdicts, [](const evaluation::MaskVerdict& verdict) {
    return verdict.judgement == evaluation::Judgement::kFails;
  });
}

int run_stability(const StabilityOptions& options) {
  const FigureFile figure(options.figure);
  std::optional<reports::OutputFile> page;  // refuses before the work what cannot be written
  if (!options.html.empty()) page.emplace(options.html);
  const std::vector<evaluation::ClockMask> masks = masks_of(options.limits);
  std::vector<reports::StabilityFinding> found;
  for (const std::string& file : options.files) {
    reports::StabilityFinding finding{
        .log = evaluation::stability_of_log(evaluation::read_clock_log(file, options.log),
                                            options.stability)};
    if (finding.log.are_summaries && !masks.empty()) {
      throw scenarios::InputError(
          file +
          ": found summaries (rms, max), which no limit judges, allowed: a line for each update");
    }
    for (const evaluation::ClockMask& mask : masks) {
      finding.verdicts.push_back(evaluation::judge(finding.log.stability, mask));
    }
    found.push_back(std::move(finding));
  }
  for (const reports::StabilityFinding& finding : found) {
    for (const std::string& note : finding.log.notes) print_note(note);
  }
  print_result_in(options.format, [&found](const std::string& format) {
    return format == "json"  ? reports::stability_json(found)
           : format == "csv" ? reports::stability_csv(found)
                             : reports::drawn_as(format, reports::stability_document(found));
  });
  if (page) {
    page->write(
        reports::stability_html({.findings = found, .masks = masks, .command = options.command}));
    page->publish();
    print_note(options.html + " written");
  }
  // Last: without gnuplot the results are there all the same.
  if (figure) {
    figure.draw(reports::stability_figure(found, masks));
    print_note(figure.path() + " written");
  }
  return std::ranges::all_of(found, keeps_limits) ? kOk : kGateFailed;
}

}  // namespace

void add_stability_command(CommandLine& line) {
  auto options = std::make_shared<StabilityOptions>();
  options->command = line.arguments;
  Command command(line, "stability",
                  "How stable a measured clock is: ADEV, TDEV, MTIE, time error");
  command.texts("files", "FILE...", options->files, "Logs of clocks, one clock each").required();
  command.text(
      "--unit", "UNIT", options->unit,
      "Unit of the time errors of tables whose headings state none (error_ms does): s, ms, "
      "us, ns, ps");
  command.text("--time-unit", "UNIT", options->time_unit,
               "Unit of their times; also ticks: 8ns, 90kHz");
  Option series = command.text(
      "--series", "NAME", options->log.series,
      "Which series of a file that has several: a host, a process, an interface, a clock or a "
      "source of a log;\na column of a table, or its number. Without NAME: lists them");
  series.or_nothing();
  command.number("--interval-s,--tau0", "SECONDS", options->stability.interval_s,
                 kShortestIntervalS, kLongestIntervalS,
                 "The distance of points. Default: the median of the file; a table of one column "
                 "needs it");
  command.flag("--frequencies", options->log.frequencies,
               "The table has fractional frequencies; their sum is the time error");
  command.flag("--locked", options->log.locked,
               "Without the points before the servo locked (s0, s1 of linuxptp)");
  command.text("--from", "TIME", options->from,
               "Without what is before: seconds since the first point, or a time (ISO 8601)");
  command.text("--until", "TIME", options->until, "Without what is behind");
  command.flag("--settle", options->stability.settle,
               "Without the start, of a clock that was not set yet");
  command.flag("--remove-frequency", options->stability.remove_frequency,
               "Remove the frequency offset (a least-squares line) before anything else");
  add_mask_options(command, options->limits);
  command.output("--figure", "FILE", options->figure,
                 "Draw ADEV, TDEV and MTIE with their intervals and limits to this file (.svg or\n"
                 ".pdf, by gnuplot)");
  command.output(
      "--html", "FILE.html", options->html,
      "Write a page, too: the verdict, the time error, ADEV, TDEV and MTIE, the tables.\n"
      "It is one file, which opens offline");
  command.format(options->format, {"table", "markdown", "csv", "json"});
  command.footer(kStabilityExamples);
  command.runs(
      [options, series] {
        return series.given() && options->log.series.empty() ? list_series(*options)
                                                             : run_stability(*options);
      },
      [options] { check_options(*options); });
}

}  // namespace simbench::cli
