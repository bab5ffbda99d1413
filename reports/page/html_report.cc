#include "reports/page/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "algorithms/ports/assert.h"
#include "reports/clocks/clock_report.h"
#include "reports/page/html_page.h"
#include "reports/page/overview.h"
#include "reports/page/side_by_side.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"
#include "scenarios/choices.h"

namespace simbench::reports {
namespace {

using evaluation::Row;

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
  if (is_of_files(archive)) {
    return html_scenario("The files and what was scored of them",
                         Json::parse(archive.scenario_json).dump(2));
  }
  return html_scenario(
      fmt::format("Saved to a file, it repeats the run: <code>simbench {} --scenario FILE --seeds "
                  "{} --first-seed {}</code>",
                  repeating_command(archive.results), archive.results.seed_count,
                  archive.results.first_seed),
      Json::parse(archive.scenario_json).dump(2));
}

scenarios::TableKind table_kind_of(const Archive& archive) {
  return scenarios::from_text<scenarios::TableKind>(scenario_text(archive, "/evaluation/table"))
      .value_or(scenarios::TableKind::kPipelines);
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
  if (table_kind_of(archive) == scenarios::TableKind::kLeaderboard)
    append(board_blocks(archive.results));
  if (archive.results.kind == evaluation::ResultKind::kClockRuns) {
    append(clock_document(clock_results_of(archive), "").blocks);
  } else {
    append(results_document(archive.results, "").blocks);
  }
  return blocks;
}

// "" of clock runs, whose first table is short.
std::string archive_summary(const Archive& archive) {
  if (archive.results.kind != evaluation::ResultKind::kCaptures) return "";
  std::vector<Block> summary = summary_blocks(archive.results, table_kind_of(archive));
  summary.front().heading = "Summary";
  return html(summary);
}

std::string about_archive(const Archive& archive, bool is_one_of_several) {
  std::string about = html_paragraph("summary", scenario_text(archive, "/summary"));
  for (const std::string& line : scenarios::derivation_lines(archive.results.derivation)) {
    about += html_paragraph("provenance", line);
  }
  about += html_paragraph("provenance", provenance_line(archive));
  if (is_one_of_several) about += html_paragraph("provenance", "Archive: " + archive.path);
  return about;
}

// The part of the page for one archive; `number`: its place among them.
HtmlArticle article_of(const ReportedArchive& reported, std::size_t number,
                       const ReportInput& input) {
  const Archive& archive = reported.archive;
  const bool is_of_clocks = archive.results.kind == evaluation::ResultKind::kClockRuns;
  const Row* const best = evaluation::best_of(archive.results);
  return {.number = number,
          .name = archive.path,
          .heading = scenarios::named(archive.results.scenario, archive.results.derivation),
          .answer = reported.answer,
          .lead = overview_html(archive.results),
          .lead_figures = {is_of_clocks ? "clocks" : "budget"},
          .lead_pipeline = best == nullptr ? "" : best->pipeline,
          .summary = archive_summary(archive),
          .about = about_archive(archive, input.archives.size() > 1),
          .body = html(blocks_of(archive)),
          .has_more_figures = !is_of_clocks,
          .figure_notes = html_notes(reported.notes),
          .reproduce = commands_of(reported, input) + scenario_details(archive)};
}

std::string title_of(const ReportInput& input) {
  std::string title = "simbench";
  for (const ReportedArchive& reported : input.archives) {
    const std::string& scenario = reported.archive.results.scenario;
    if (title.find(scenario) == std::string::npos) title += fmt::format(" {}", scenario);
  }
  return title;
}

const char* subtitle_of(const ReportInput& input) {
  const bool is_of_cameras = std::ranges::any_of(input.archives, [](const auto& reported) {
    return reported.archive.results.kind == evaluation::ResultKind::kCaptures;
  });
  return is_of_cameras ? "how well are these cameras synchronised, and what limits it"
                       : "how well do these clocks agree, and what limits it";
}

}  // namespace

std::string html_report(const ReportInput& input) {
  SIMBENCH_ASSERT(!input.archives.empty(), "a report is of at least one archive");
  std::string parts;
  std::vector<std::string> data;
  if (input.front) {
    parts += html_article(input.front->article);
    data.push_back(figures_json(input.front->figures));
  } else {
    SideBySide several = archives_side_by_side(input.archives, input.command);
    parts += several.above;
    for (HtmlArticle& article : several.articles) {
      article.number = data.size();
      parts += html_article(article);
      data.push_back(std::move(several.data[article.number]));
    }
  }
  for (const ReportedArchive& reported : input.archives) {
    parts += html_article(article_of(reported, data.size(), input));
    data.push_back(figures_json(reported.figures));
  }
  return html_page({.title = input.front ? input.front->title : title_of(input),
                    .subtitle = input.front ? input.front->subtitle : subtitle_of(input),
                    .main = parts,
                    .data = data});
}

}  // namespace simbench::reports
