#include "reports/page/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"
#include "reports/clocks/clock_report.h"
#include "reports/page/html_page.h"
#include "reports/page/overview.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"
#include "reports/text/html_text.h"
#include "reports/text/json_node.h"
#include "reports/text/time_text.h"
#include "scenarios/choices.h"

namespace simbench::reports {
namespace {

using evaluation::Row;
using evaluation::Series;

// A text member of the resolved scenario; "" if it or the scenario is missing.
std::string scenario_text(const Archive& archive, const char* pointer) {
  if (archive.scenario_json.empty()) return "";
  return Json::parse(archive.scenario_json).value(Json::json_pointer(pointer), std::string());
}

std::string provenance_line(const Archive& archive) {
  const evaluation::Results& results = archive.results;
  std::string line =
      fmt::format("{} of simbench {} ({})", counted_seeds(results.first_seed, results.seed_count),
                  archive.version, archive.commit);
  if (!archive.started.empty()) {
    line += fmt::format(", run from {} to {}", archive.started, archive.finished);
  }
  return line;
}

std::string commands_of(const ReportedArchive& reported, const ReportInput& input) {
  const Archive& archive = reported.archive;
  std::string lines;
  if (!archive.command.empty())
    lines += html_command("The results", simbench_line(archive.command));
  lines += html_command("This report", simbench_line(input.command));
  if (!reported.figures.empty() && archive.results.kind == evaluation::ResultKind::kCaptures) {
    lines +=
        html_command("One figure alone, for a paper",
                     fmt::format("simbench figure {} {} -o {}.svg", reported.figures.front().id,
                                 shell_line({archive.path}), reported.figures.front().id));
  }
  return fmt::format("<dl>\n{}</dl>\n", lines);
}

// The words that a command line for these results begins with.
std::string repeating_command(const evaluation::Results& results) {
  if (results.kind == evaluation::ResultKind::kCaptures) return "run";
  return fmt::format("clocks --duration-s {} --from-s {}", results.clock_period.duration_s,
                     results.clock_period.from_s);
}

std::string scenario_details(const Archive& archive) {
  if (archive.scenario_json.empty()) {
    return "<p>A results.json alone holds neither the scenario nor the command that ran it.</p>\n";
  }
  return fmt::format(
      "<details><summary>The resolved scenario</summary>\n<p>Saved to a file, it repeats the run: "
      "<code>simbench {} --scenario FILE --seeds {} --first-seed {}</code></p>\n"
      "<pre class=\"scroll\" tabindex=\"0\">{}</pre>\n</details>\n",
      repeating_command(archive.results), archive.results.seed_count, archive.results.first_seed,
      html_escaped(Json::parse(archive.scenario_json).dump(2)));
}

bool is_leaderboard(const Archive& archive) {
  return scenario_text(archive, "/evaluation/table") == to_text(scenarios::TableKind::kLeaderboard);
}

// The warnings and tables of a run, a leaderboard or the clocks alone, as their commands print
// them.
std::vector<Block> blocks_of(const Archive& archive) {
  std::vector<Block> blocks;
  const auto append = [&blocks](const std::vector<Block>& more) {
    blocks.insert(blocks.end(), more.begin(), more.end());
  };
  if (!archive.results.warnings.empty()) {
    append({{.heading = "Warnings", .items = archive.results.warnings, .is_warning = true}});
  }
  if (is_leaderboard(archive)) append(board_blocks(archive.results));
  if (archive.results.kind == evaluation::ResultKind::kClockRuns) {
    append(clock_document(clock_results_of(archive), "").blocks);
  } else {
    append(results_document(archive.results, "").blocks);
  }
  return blocks;
}

// The answer, the figures that explain it, and the summary.
std::string first_part(const ReportedArchive& reported) {
  std::string text;
  for (const std::string& paragraph : reported.answer.prose) {
    text += html_paragraph("answer", paragraph);
  }
  const evaluation::Results& results = reported.archive.results;
  const bool by_error = is_leaderboard(reported.archive);
  if (results.kind == evaluation::ResultKind::kCaptures) {
    text += overview_html(
        results, by_error ? evaluation::RankedBy::kAbsoluteError : evaluation::RankedBy::kAmd);
  }
  text += "<div class=\"figures lead\"></div>\n";
  if (results.kind != evaluation::ResultKind::kCaptures) return text;
  std::vector<Block> summary = summary_blocks(results, by_error);
  summary.front().heading = "Summary";
  return text + html(summary);
}

// The part of the page for one archive; `number`: its place among them.
std::string archive_part(const ReportedArchive& reported, std::size_t number,
                         const ReportInput& input) {
  const Archive& archive = reported.archive;
  const std::string heading =
      scenarios::named(archive.results.scenario, archive.results.derivation);
  std::string derivation;
  for (const std::string& line : scenarios::derivation_lines(archive.results.derivation)) {
    derivation += html_paragraph("provenance", line);
  }
  return fmt::format(
      "<article class=\"archive\" data-archive=\"{}\" data-name=\"{}\">\n<h2>{}</h2>\n{}{}{}{}{}"
      "<h3>Figures</h3>\n{}<div class=\"figures\"></div>\n"
      "<section class=\"reproduce\"><h3>How to reproduce it</h3>\n{}{}</section>\n</article>\n",
      number, html_escaped(archive.path), html_escaped(heading), first_part(reported),
      html_paragraph("summary", scenario_text(archive, "/summary")) + derivation,
      html_paragraph("provenance", provenance_line(archive)),
      input.archives.size() > 1 ? html_paragraph("provenance", "Archive: " + archive.path) : "",
      html(blocks_of(archive)), html_notes(reported.notes), commands_of(reported, input),
      scenario_details(archive));
}

std::string title_of(const ReportInput& input) {
  std::string title = "simbench";
  for (const ReportedArchive& reported : input.archives) {
    const std::string& scenario = reported.archive.results.scenario;
    if (title.find(scenario) == std::string::npos) title += fmt::format(" {}", scenario);
  }
  return title;
}

std::string cell_of(const Archive& archive, const std::string& pipeline, Series Row::*series) {
  const Row* const row = evaluation::find_row(archive.results.rows, pipeline);
  if (row == nullptr || std::isnan(((*row).*series).median)) return "-";
  const Series& values = (*row).*series;
  return fmt::format("{} {}{}", time_text(values.median), time_band_text(values.p05, values.p95),
                     is_unverified(*row) ? " (unverified)" : "");
}

// The pipelines of all archives, in order.
std::vector<std::string> pipelines_of(const std::vector<ReportedArchive>& archives) {
  std::vector<std::string> pipelines;
  for (const ReportedArchive& reported : archives) {
    for (const Row& row : reported.archive.results.rows) {
      if (std::find(pipelines.begin(), pipelines.end(), row.pipeline) == pipelines.end()) {
        pipelines.push_back(row.pipeline);
      }
    }
  }
  return pipelines;
}

// Empty for a single archive.
std::vector<Block> archive_blocks(const std::vector<ReportedArchive>& archives) {
  if (archives.size() < 2) return {};
  std::vector<Field<std::string>> fields = {
      {{"pipeline", Align::kLeft}, [](const std::string& pipeline) { return pipeline; }}};
  const auto add = [&fields](const Archive& archive, const char* what, Series Row::*series) {
    fields.push_back({{fmt::format("{}: {}", archive.path, what)},
                      [&archive, series](const std::string& pipeline) {
                        return cell_of(archive, pipeline, series);
                      }});
  };
  for (const ReportedArchive& reported : archives) {
    add(reported.archive, "AMD", &Row::amd_ms);
    add(reported.archive, "absolute error", &Row::absolute_error_ms);
  }
  return {{.heading = "The archives side by side",
           .table = table_of(fields, pipelines_of(archives)),
           .prose = {"Median over the seeds with the band from 5 to 95 %. simbench compare tests "
                     "whether a difference is significant."}}};
}

}  // namespace

std::string html_report(const ReportInput& input) {
  SIMBENCH_ASSERT(!input.archives.empty(), "a report is of at least one archive");
  std::string parts;
  std::vector<std::string> data;
  for (std::size_t i = 0; i < input.archives.size(); ++i) {
    parts += archive_part(input.archives[i], i, input);
    data.push_back(figures_json(input.archives[i].figures));
  }
  return html_page({.title = title_of(input),
                    .subtitle = "how well are these cameras synchronised, and what limits it",
                    .main = html(archive_blocks(input.archives)) + parts,
                    .data = data});
}

}  // namespace simbench::reports
