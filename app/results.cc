#include "app/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/sweep/sweep_score.h"
#include "evaluation/sweep/sweep_standing.h"
#include "reports/clocks/clock_report.h"
#include "reports/figures/gnuplot.h"
#include "reports/page/sweep_page.h"
#include "reports/results/csv.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/answer_json.h"
#include "reports/text/output_file.h"
#include "reports/text/plain_text.h"

namespace simbench::app {
namespace {

using evaluation::ResponseRow;
using evaluation::SweepPlan;
using evaluation::SweepScore;
using scenarios::StudyTable;

std::vector<SweepScore> scores_in(const reports::SweepLog& log, const SweepPlan& plan) {
  std::vector<SweepScore> scores;
  scores.reserve(plan.runs());
  for (std::size_t run = 0; run < plan.runs(); ++run) {
    std::optional<SweepScore> score = evaluation::score_of(log.text(run), plan.kind);
    SIMBENCH_ASSERT(score.has_value(), "the log's checksums hold, so its texts are scores");
    scores.push_back(std::move(*score));
  }
  return scores;
}

// Whether a pipeline's programs ended in every seed of every point.
bool failed_in_all_runs(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::vector<std::uint64_t> failed(plan.pipelines.size());
  for (const ResponseRow& row : rows) failed[row.pipeline] += row.failed_seeds;
  return std::ranges::count(failed, plan.points() * plan.seeds) > 0;
}

reports::Document document_of(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                              const std::vector<StudyTable>& tables,
                              const reports::AnswerText& answer) {
  reports::Document document{.head = paragraphs(answer)};
  if (!plan.derivation.changes.empty()) {
    document.head.push_back(scenarios::changed_text(plan.derivation));
  }
  for (const StudyTable table : tables) {
    document.blocks.push_back(
        table == StudyTable::kHostOrder     ? reports::host_order_block(plan, rows)
        : table == StudyTable::kSeedsNeeded ? reports::seeds_needed_block(plan, rows)
        : table == StudyTable::kRanking     ? reports::ranking_block(plan, rows)
        : table == StudyTable::kPackets     ? reports::packets_block(plan, rows)
                                            : reports::response_block(plan, rows));
  }
  return document;
}

std::string text_for_file(const reports::Document& document) {
  const reports::FilePage page;
  return plain(document);
}

reports::Figure figure_of(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                          StudyTable table) {
  if (table == StudyTable::kHostOrder) return reports::host_order_figure(plan, rows);
  if (table == StudyTable::kSeedsNeeded) return reports::seeds_needed_figure(plan, rows);
  if (table == StudyTable::kPackets) return reports::packets_figure(plan, rows);
  return reports::response_figure(plan, rows);
}

// Returns the figures of the tables, each once; the first is that of the first table.
std::vector<reports::Figure> figures_of(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                                        const std::vector<StudyTable>& tables) {
  std::vector<reports::Figure> figures;
  for (const StudyTable table : tables) {
    reports::Figure figure = figure_of(plan, rows, table);
    const bool is_there = std::ranges::any_of(
        figures, [&figure](const reports::Figure& other) { return other.id == figure.id; });
    if (!is_there) figures.push_back(std::move(figure));
  }
  return figures;
}

// Returns why the figure was not drawn, which is no error; empty if it was.
std::string draw_figure(const reports::Figure& figure, reports::SweepFolder& folder) {
  constexpr const char* kName = "sweep.svg";
  folder.remove(kName);
  if (figure.panels.empty()) return "";
  std::string svg;
  try {
    svg = reports::drawn_svg(figure);
  } catch (const reports::OutputError& error) {
    return fmt::format("{} was not drawn: {}", kName, error.what());
  }
  folder.write(kName, svg);
  return "";
}

}  // namespace

std::string clock_text(const evaluation::ClockResults& results, const scenarios::Scenario& scenario,
                       const std::string& format) {
  if (format == "json") return reports::clock_json(results);
  if (format == "csv") return reports::clock_csv(results);
  if (format == "tidy") return reports::tidy_csv(results.results);
  const reports::Document document = reports::clock_document(results, scenario.summary);
  return reports::drawn_as(format, document);
}

RunArchive::RunArchive(std::vector<std::string> command) {
  provenance_.command = std::move(command);
  provenance_.started = std::chrono::system_clock::now();
}

void RunArchive::open(const std::string& folder) {
  if (folder.empty()) return;
  folder_ = std::make_unique<reports::OutputFolder>(folder, reports::clock_archive_files());
}

bool RunArchive::write(const evaluation::Results& results, const scenarios::Scenario& scenario,
                       const reports::ResultsAnswer* answer) {
  if (!folder_) return false;
  provenance_.finished = std::chrono::system_clock::now();
  reports::write_archive(*folder_, results, scenario, provenance_, answer);
  return true;
}

bool RunArchive::write(const evaluation::ClockResults& results,
                       const scenarios::Scenario& scenario) {
  if (!folder_) return false;
  provenance_.finished = std::chrono::system_clock::now();
  reports::write_clock_archive(*folder_, results, scenario, provenance_);
  return true;
}

SweepText write_sweep_results(const SweepPlan& plan, const std::vector<StudyTable>& tables,
                              reports::SweepFolder& folder) {
  const std::vector<SweepScore> scores = scores_in(folder.log(), plan);
  const std::vector<ResponseRow> rows = evaluation::response(plan, scores);
  folder.write("sweep.csv", reports::sweep_csv(plan, scores));
  folder.write("hosts.csv", reports::sweep_hosts_csv(plan, scores));
  const reports::AnswerText answer = reports::sweep_answer(plan, rows);
  reports::Document document = document_of(plan, rows, tables, answer);
  const std::vector<reports::Figure> figures = figures_of(plan, rows, tables);
  folder.write("sweep.txt", text_for_file(document));
  reports::Json for_programs = reports::new_document();
  for_programs["scenario"] = plan.scenario;
  for_programs["ranked_by"] = evaluation::ranked_metric(evaluation::ranking_of(plan, rows)).id;
  for_programs["answer"] = reports::answer_json(answer);
  folder.write("answer.json", reports::file_text(for_programs));
  folder.write(
      "sweep.html",
      reports::sweep_html(
          {.plan = plan, .answer = answer, .figures = figures, .blocks = document.blocks}));
  std::string not_drawn = draw_figure(figures.front(), folder);
  folder.log().put_in_order();
  return {.document = std::move(document),
          .not_drawn = std::move(not_drawn),
          .has_failed = failed_in_all_runs(plan, rows)};
}

}  // namespace simbench::app
