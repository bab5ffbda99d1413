#include "explore/picture.h"

#include "evaluation/answer/answer.h"
#include "recording/collected.h"
#include "reports/comparison/comparison.h"
#include "reports/figures/comparison_figures.h"
#include "reports/page/html_page.h"
#include "reports/page/overview.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"
#include "reports/text/answer_json.h"
#include "scenarios/derivation.h"
#include "scenarios/loader.h"

namespace simbench::explore {

using evaluation::Results;
using evaluation::Row;
using reports::Json;
using scenarios::Scenario;

Json picture_json(const Results& results, const Scenario& scenario,
                  const reports::ResultsAnswer& answer) {
  const Row* const best = evaluation::best_of(results);
  return {{"scenario", scenarios::named(results.scenario, results.derivation)},
          {"summary", scenario.summary},
          {"answer", reports::answer_json(answer.text)},
          {"best", best == nullptr ? Json() : Json(best->pipeline)},
          {"pipelines", collected(results.rows, &Row::pipeline)},
          {"overview", reports::overview_html(results)},
          {"table", reports::html(reports::summary_blocks(results, scenario.evaluation.table))},
          {"warnings", results.warnings}};
}

std::string tables_html(const Results& results, const Scenario& scenario) {
  std::vector<reports::Block> all = reports::results_document(results, "").blocks;
  const bool is_board = scenario.evaluation.table == scenarios::TableKind::kLeaderboard;
  if (is_board) {
    const std::vector<reports::Block> boards = reports::board_blocks(results);
    all.insert(all.begin(), boards.begin(), boards.end());
  }
  return reports::html(all);
}

reports::Archive archive_of(const Results& results, const Scenario& scenario,
                            const std::string& name) {
  return reports::kept_archive(name, results, scenario, {});
}

Json comparison_of(const reports::Archive& a, const reports::Archive& b) {
  const reports::Comparison comparison =
      reports::compare_archives(a, b, {.different_scenarios = true});
  return {{"answer", reports::answer_json(reports::comparison_answer(comparison))},
          {"tables", reports::html(reports::comparison_document(comparison).blocks)},
          {"data", Json::parse(reports::figures_json(reports::comparison_figures(comparison)))}};
}

}  // namespace simbench::explore
