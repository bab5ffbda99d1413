#include "reports/stability/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "recording/counted.h"
#include "recording/text_fields.h"
#include "reports/stability/verdict_text.h"
#include "reports/text/answer_json.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Certainty;
using evaluation::ClockCurve;
using evaluation::Deviation;
using evaluation::Judgement;
using evaluation::LogStability;
using evaluation::MaskVerdict;
using evaluation::Stability;
using evaluation::StabilityPoint;

constexpr std::size_t kStepsInText = 10;

// Curves of times are in ms; ADEV and its kin have no unit.
bool is_time(const ClockCurve& curve) { return std::string_view(curve.axis).ends_with(" ms"); }

std::string in_unit(std::string_view header_ms, const ShownUnit& unit) {
  return std::string(header_ms.substr(0, header_ms.size() - 2)) + unit.name;
}

// The unit on a line of its own.
std::string column_header(const ClockCurve& curve, const ShownUnit& unit) {
  std::string header = is_time(curve) ? in_unit(curve.axis, unit) : curve.axis;
  std::replace(header.begin(), header.end(), ' ', '\n');
  return header;
}

struct Size {
  const char* name;
  const char* header;  // null: in no table
  double evaluation::TimeErrorSummary::*value;
};
constexpr std::array<Size, 9> kSizes = {
    {{"max_te_ms", "max |TE|\nms", &evaluation::TimeErrorSummary::max_te_ms},
     {"rms_te_ms", "RMS TE\nms", &evaluation::TimeErrorSummary::rms_te_ms},
     {"constant_te_ms", "constant\nTE ms", &evaluation::TimeErrorSummary::constant_te_ms},
     {"dynamic_te_ms", "dynamic TE\nRMS ms", &evaluation::TimeErrorSummary::dynamic_te_ms},
     {"dynamic_te_p2p_ms", "dynamic TE\np-p ms", &evaluation::TimeErrorSummary::dynamic_te_p2p_ms},
     {"p50_te_ms", nullptr, &evaluation::TimeErrorSummary::p50_te_ms},
     {"p95_te_ms", nullptr, &evaluation::TimeErrorSummary::p95_te_ms},
     {"p99_te_ms", nullptr, &evaluation::TimeErrorSummary::p99_te_ms},
     {"p99_9_te_ms", nullptr, &evaluation::TimeErrorSummary::p99_9_te_ms}}};

// Three digits, of nanoseconds as of seconds.
std::string three_digits(double value) { return value == 0 ? "0" : fmt::format("{:.3g}", value); }

std::int64_t gaps_of(const LogStability& file) {
  return std::max<std::int64_t>(file.stability.pieces - 1, 0);
}

// Summaries have only a largest and an RMS time error.
bool has_size(const LogStability& file, const Size& size) {
  return !file.are_summaries || size.value == &evaluation::TimeErrorSummary::max_te_ms ||
         size.value == &evaluation::TimeErrorSummary::rms_te_ms;
}

double seconds_of(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

std::string offset_text(const LogStability& file) {
  return file.frequency_offset ? fmt::format("{:.6g}", 1e9 * *file.frequency_offset) : "-";
}

// The unit that fits the largest of them.
const ShownUnit& unit_of_errors(const std::vector<StabilityFinding>& findings) {
  double largest_ms = 0;
  for (const StabilityFinding& finding : findings) {
    for (const Size& size : kSizes) {
      const double ms = std::abs(finding.log.stability.time_error.*size.value);
      if (size.header != nullptr && has_size(finding.log, size) && std::isfinite(ms)) {
        largest_ms = std::max(largest_ms, ms);
      }
    }
  }
  return time_unit_of(largest_ms);
}

const ShownUnit& unit_of_curves(const Stability& stability) {
  double largest_ms = 0;
  for (const ClockCurve& curve : evaluation::clock_curves()) {
    for (const StabilityPoint& point : stability.*curve.points) {
      if (is_time(curve)) largest_ms = std::max(largest_ms, point.value);
    }
  }
  return time_unit_of(largest_ms);
}

Table files_table(const std::vector<StabilityFinding>& findings) {
  const ShownUnit& unit = unit_of_errors(findings);
  std::vector<Column> columns = {{"file", Align::kLeft},
                                 {"format", Align::kLeft},
                                 {"points"},
                                 {"interval\ns"},
                                 {"gaps"},
                                 {"steps"},
                                 {"removed\nppb"}};
  for (const Size& size : kSizes) {
    if (size.header != nullptr) columns.push_back({in_unit(size.header, unit)});
  }
  Table table(columns);
  for (const StabilityFinding& finding : findings) {
    const LogStability& file = finding.log;
    const Stability& stability = file.stability;
    std::vector<std::string> cells = {log_name(file),
                                      file.format,
                                      count_text(file.samples),
                                      fmt::format("{:.6g}", stability.interval_s),
                                      count_text(gaps_of(file)),
                                      count_text(static_cast<std::int64_t>(stability.steps.size())),
                                      offset_text(file)};
    for (const Size& size : kSizes) {
      if (size.header == nullptr) continue;
      cells.push_back(has_size(file, size)
                          ? three_digits(unit.per_ms * stability.time_error.*size.value)
                          : "-");
    }
    table.add(std::move(cells));
  }
  return table;
}

std::vector<std::string> step_items(const Stability& stability) {
  std::vector<std::string> items;
  for (const evaluation::TimeErrorStep& step : stability.steps) {
    if (items.size() == kStepsInText) {
      items.push_back(fmt::format("{} more: JSON has all", stability.steps.size() - kStepsInText));
      break;
    }
    items.push_back(fmt::format("step of {} at {:.9g} s after the first point",
                                time_text(1e3 * step.step_s), step.at_s));
  }
  return items;
}

Json start_json(const LogStability& file) {
  if (!file.start) return nullptr;
  return {{"points", file.start->points},
          {"until_s", file.start->until_s},
          {"largest_ms", file.start->largest_ms},
          {"left_out", file.settled},
          {"settled_max_te_ms", file.start->settled.max_te_ms},
          {"settled_rms_te_ms", file.start->settled.rms_te_ms}};
}

// How the time error is with and without the start.
std::string start_text(const LogStability& file) {
  const evaluation::LogStart& start = *file.start;
  const std::string points = counted(static_cast<std::uint64_t>(start.points), "point");
  if (file.settled) {
    return fmt::format(
        "The first {} ({:.6g} s), of a clock that was not set yet, left out: up to {}.", points,
        start.until_s, time_text(start.largest_ms));
  }
  return fmt::format(
      "The first {} ({:.6g} s) are of a clock that was not set yet: without them ({}) the largest "
      "time error is {}, its RMS {}.",
      points, start.until_s, "--settle", time_text(start.settled.max_te_ms),
      time_text(start.settled.rms_te_ms));
}

Json file_json(const StabilityFinding& finding) {
  const LogStability& file = finding.log;
  Json object = {{"file", file.file},
                 {"format", file.format},
                 {"series", file.series},
                 {"first_s", file.first_s},
                 {"interval_s", file.stability.interval_s},
                 {"samples", file.samples},
                 {"points", file.stability.points},
                 {"left_out", file.left_out},
                 {"gaps", gaps_of(file)},
                 {"longest_gap_s", file.longest_gap_s},
                 {"frequency_offset_ppb", nullptr}};
  if (file.frequency_offset) object["frequency_offset_ppb"] = 1e9 * *file.frequency_offset;
  object["summaries"] = file.are_summaries;
  object["start"] = start_json(file);
  add_stability(object, file.stability);
  for (const Size& size : kSizes) {
    if (!has_size(file, size)) object[size.name] = nullptr;
  }
  object["steps"] = Json::array();
  for (const evaluation::TimeErrorStep& step : file.stability.steps) {
    object["steps"].push_back({{"at_s", step.at_s}, {"step_ms", 1e3 * step.step_s}});
  }
  object["verdicts"] = Json::array();
  for (const MaskVerdict& verdict : finding.verdicts) {
    object["verdicts"].push_back(mask_verdict_json(verdict));
  }
  object["notes"] = file.notes;
  return object;
}

// Whether the text has room for the intervals of a curve.
bool has_interval_in_text(const ClockCurve& curve) {
  return curve.deviation == Deviation::kAdev || curve.deviation == Deviation::kTdev;
}

bool is_reliable(const ClockCurve& curve, const StabilityPoint& point) {
  return curve.deviation == Deviation::kMtie || (point.certainty && point.certainty->reliable);
}

std::string interval_of_point_text(const std::optional<Certainty>& certainty, double per_unit) {
  return certainty
             ? fmt::format("{:.2g}..{:.2g}", per_unit * certainty->low, per_unit * certainty->high)
             : "-";
}

// The point as points_json() has it, and its certainty.
void add_certainty_json(Json& object, const std::optional<Certainty>& certainty) {
  for (const char* const member : {"low", "high", "noise"}) object[member] = nullptr;
  object["reliable"] = certainty && certainty->reliable;
  if (!certainty) return;
  object["low"] = certainty->low;
  object["high"] = certainty->high;
  object["noise"] = evaluation::noise_id(certainty->noise);
}

// The last four cells of a line.
std::string certainty_csv(const ClockCurve& curve, const std::optional<Certainty>& certainty) {
  if (!certainty) return curve.deviation == Deviation::kMtie ? ",,," : ",,,0";
  return fmt::format("{},{},{},{}", csv_cell(certainty->low), csv_cell(certainty->high),
                     evaluation::noise_id(certainty->noise), certainty->reliable ? 1 : 0);
}

std::string percentiles_text(const evaluation::TimeErrorSummary& size) {
  return fmt::format(
      "|TE| is at most {} in 50 %, {} in 95 %, {} in 99 %, {} in 99.9 % of the points.",
      time_text(size.p50_te_ms), time_text(size.p95_te_ms), time_text(size.p99_te_ms),
      time_text(size.p99_9_te_ms));
}

// The sentence of a single verdict, else how many say what, and those that fail.
std::string limits_text(const std::vector<StabilityFinding>& findings) {
  std::array<std::uint64_t, 3> counts{};
  std::string failures;
  std::string single;
  for (const StabilityFinding& finding : findings) {
    for (const MaskVerdict& verdict : finding.verdicts) {
      ++counts[static_cast<std::size_t>(verdict.judgement)];
      single = mask_verdict_text(verdict);
      if (verdict.judgement == Judgement::kFails) {
        failures += fmt::format(" {}, {}", finding.log.file, single);
      }
    }
  }
  const auto [passed, failed, untold] = counts;
  const std::uint64_t all = passed + failed + untold;
  if (all < 2) return single;
  return fmt::format("{}: {} passed, {} failed, {} cannot be judged as a whole.{}",
                     counted(all, "verdict"), passed, failed, untold, failures);
}

}  // namespace

Table stability_table(const Stability& stability) {
  const ShownUnit& unit = unit_of_curves(stability);
  std::vector<Column> columns = {{"tau s"}};
  for (const ClockCurve& curve : evaluation::clock_curves()) {
    columns.push_back({column_header(curve, unit)});
    if (has_interval_in_text(curve)) columns.push_back({"95 %\ninterval"});
  }
  Table table(columns);
  // MTIE reaches farthest, and all begin at one interval and go on by octaves.
  std::size_t octaves = 0;
  for (const ClockCurve& curve : evaluation::clock_curves())
    octaves = std::max(octaves, (stability.*curve.points).size());
  for (std::size_t i = 0; i < octaves; ++i) {
    std::vector<std::string> cells = {
        fmt::format("{:.6g}", std::ldexp(stability.interval_s, static_cast<int>(i)))};
    for (const ClockCurve& curve : evaluation::clock_curves()) {
      const std::vector<StabilityPoint>& points = stability.*curve.points;
      const bool exists = i < points.size();
      const double per_unit = is_time(curve) ? unit.per_ms : 1;
      cells.push_back(!exists ? "-"
                              : three_digits(per_unit * points[i].value) +
                                    (is_reliable(curve, points[i]) ? "" : "?"));
      if (has_interval_in_text(curve)) {
        cells.push_back(exists ? interval_of_point_text(points[i].certainty, per_unit) : "-");
      }
    }
    table.add(std::move(cells));
  }
  return table;
}

Json points_json(const std::vector<StabilityPoint>& points) {
  Json list = Json::array();
  for (const StabilityPoint& point : points) {
    list.push_back({{"tau_s", point.tau_s}, {"value", point.value}, {"terms", point.terms}});
  }
  return list;
}

void add_stability(Json& object, const Stability& stability) {
  for (const Size& size : kSizes) object[size.name] = stability.time_error.*size.value;
  for (const ClockCurve& curve : evaluation::clock_curves()) {
    const std::vector<StabilityPoint>& points = stability.*curve.points;
    Json& list = object[curve.id] = points_json(points);
    if (curve.deviation == Deviation::kMtie) continue;
    for (std::size_t i = 0; i < points.size(); ++i) {
      add_certainty_json(list[i], points[i].certainty);
    }
  }
}

std::string log_name(const LogStability& file) {
  return file.series.empty() ? file.file : fmt::format("{} {}", file.file, file.series);
}

AnswerText stability_answer(const std::vector<StabilityFinding>& findings) {
  if (findings.empty()) return {};
  const auto largest_te = [](const StabilityFinding& finding) {
    return finding.log.stability.time_error.max_te_ms;
  };
  const LogStability& worst = std::ranges::max_element(findings, {}, largest_te)->log;
  const evaluation::TimeErrorSummary& size = worst.stability.time_error;
  AnswerText answer{.lead = findings.size() == 1
                                ? fmt::format("The largest time error of {} is {}.",
                                              log_name(worst), time_text(size.max_te_ms))
                                : fmt::format("Of {}, {} has the largest time error: {}.",
                                              counted(findings.size(), "clock"), log_name(worst),
                                              time_text(size.max_te_ms))};
  answer.add("Limits", limits_text(findings));
  answer.add("Parts",
             worst.are_summaries
                 ? fmt::format("Its RMS is {}.", time_text(size.rms_te_ms))
                 : fmt::format("Its mean is {}, what changes around it {} (RMS).",
                               time_text(size.constant_te_ms), time_text(size.dynamic_te_ms)));
  for (const StabilityFinding& finding : findings) {
    if (!finding.log.start) continue;
    answer.add("Start", findings.size() == 1 ? start_text(finding.log)
                                             : fmt::format("{}: {}", log_name(finding.log),
                                                           start_text(finding.log)));
  }
  std::int64_t steps = 0;
  std::int64_t gaps = 0;
  for (const StabilityFinding& finding : findings) {
    steps += static_cast<std::int64_t>(finding.log.stability.steps.size());
    gaps += gaps_of(finding.log);
  }
  if (steps + gaps > 0) {
    answer.add("Breaks",
               fmt::format("{} and {} in all.", counted(static_cast<std::uint64_t>(steps), "step"),
                           counted(static_cast<std::uint64_t>(gaps), "gap")));
  }
  return answer;
}

Document stability_document(const std::vector<StabilityFinding>& findings) {
  Document document{.title = "stability of " + counted(findings.size(), "measured clock"),
                    .head = paragraphs(stability_answer(findings))};
  document.blocks.push_back({.heading = "Time error (TE)", .table = files_table(findings)});
  for (const StabilityFinding& finding : findings) {
    const Stability& stability = finding.log.stability;
    Block block{.heading = log_name(finding.log)};
    if (!stability.mtie_ms.empty()) block.table = stability_table(stability);
    if (!finding.log.are_summaries) block.prose = {percentiles_text(stability.time_error)};
    for (const MaskVerdict& verdict : finding.verdicts) {
      block.items.push_back(mask_verdict_text(verdict));
    }
    for (std::string& item : step_items(stability)) block.items.push_back(std::move(item));
    document.blocks.push_back(std::move(block));
  }
  document.blocks.push_back(
      {.heading = "How to read it",
       .items = {"TE: the clock minus its reference. Constant: the mean; dynamic: without it, not "
                 "filtered.",
                 "ADEV, HDEV: overlapping Allan and Hadamard deviation, MDEV: modified Allan "
                 "deviation, without a unit; TDEV: time deviation; MTIE: the largest change of TE "
                 "within tau. None reaches over a gap.",
                 "Interval: the deviation of the clock, with 95 %, if its noise is the power law "
                 "that it shows at tau. \"?\": not reliable, of too few independent differences. "
                 "MTIE has no interval.",
                 "A log has what the program estimates against its own source: an error that both "
                 "share (an asymmetric path) is not in it."}});
  return document;
}

std::string stability_csv(const std::vector<StabilityFinding>& findings) {
  std::string text = "file,format,quantity,tau_s,value,terms,low,high,noise,reliable\n";
  for (const StabilityFinding& finding : findings) {
    const LogStability& file = finding.log;
    const std::string head = csv_cell(log_name(file)) + "," + file.format + ",";
    const auto add = [&](const char* quantity, double value) {
      text += fmt::format("{}{},,{},,,,,\n", head, quantity, csv_cell(value));
    };
    const Stability& stability = file.stability;
    add("first_s", file.first_s);
    add("interval_s", stability.interval_s);
    add("samples", static_cast<double>(file.samples));
    add("points", static_cast<double>(stability.points));
    add("left_out", static_cast<double>(file.left_out));
    add("gaps", static_cast<double>(gaps_of(file)));
    add("longest_gap_s", file.longest_gap_s);
    if (file.frequency_offset) add("frequency_offset_ppb", 1e9 * *file.frequency_offset);
    for (const Size& size : kSizes) {
      if (has_size(file, size)) add(size.name, stability.time_error.*size.value);
    }
    for (const ClockCurve& curve : evaluation::clock_curves()) {
      for (const StabilityPoint& point : stability.*curve.points) {
        text +=
            fmt::format("{}{},{},{},{},{}\n", head, curve.id, csv_cell(point.tau_s),
                        csv_cell(point.value), point.terms, certainty_csv(curve, point.certainty));
      }
    }
    add("steps", static_cast<double>(stability.steps.size()));
    for (const MaskVerdict& verdict : finding.verdicts) {
      const char* const value = verdict.judgement == Judgement::kPasses  ? "1"
                                : verdict.judgement == Judgement::kFails ? "0"
                                                                         : "";
      text += fmt::format("{}{},,{},,,,,\n", head, verdict.mask, value);
    }
  }
  return text;
}

Document log_series_document(const std::vector<LogSeriesOfFile>& files) {
  Document document{.title = "series of " + counted(files.size(), "file")};
  for (const LogSeriesOfFile& file : files) {
    Table table({{"series", Align::kLeft}, {"format", Align::kLeft}, {"points"}, {"length\ns"}});
    for (const evaluation::ClockLogSeries& series : file.series) {
      table.add({series.name, series.format,
                 series.points > 0 ? count_text(static_cast<std::int64_t>(series.points)) : "-",
                 series.points > 0 ? fmt::format("{:.6g}", seconds_of(series.last - series.first))
                                   : "-"});
    }
    document.blocks.push_back({.heading = file.file, .table = std::move(table)});
  }
  return document;
}

std::string log_series_json(const std::vector<LogSeriesOfFile>& files) {
  Json root = new_document();
  root["files"] = Json::array();
  for (const LogSeriesOfFile& file : files) {
    Json list = Json::array();
    for (const evaluation::ClockLogSeries& series : file.series) {
      list.push_back({{"name", series.name},
                      {"format", series.format},
                      {"points", series.points},
                      {"first_s", seconds_of(series.first)},
                      {"last_s", seconds_of(series.last)}});
    }
    root["files"].push_back({{"file", file.file}, {"series", std::move(list)}});
  }
  return file_text(root);
}

std::string stability_json(const std::vector<StabilityFinding>& findings) {
  Json root = new_document();
  root["answer"] = answer_json(stability_answer(findings));
  root["files"] = Json::array();
  for (const StabilityFinding& finding : findings) root["files"].push_back(file_json(finding));
  return file_text(root);
}

}  // namespace simbench::reports
