#include "app/results_text.h"

#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"

namespace simbench::app {
namespace {

reports::Document document_in_detail(const evaluation::Results& results,
                                     const scenarios::Scenario& scenario, bool leaderboard,
                                     const reports::AnswerText& answer, Detail detail) {
  if (detail == Detail::kAnswer) return reports::quiet_document(results, answer);
  if (detail == Detail::kScreen) {
    return reports::summary_document(
        results, {.summary = scenario.summary, .table = scenario.evaluation.table}, answer);
  }
  reports::Document document = leaderboard
                                   ? reports::leaderboard_document(results, scenario.summary)
                                   : reports::results_document(results, scenario.summary);
  const std::vector<std::string> first = paragraphs(answer);
  document.head.insert(document.head.begin(), first.begin(), first.end());
  return document;
}

}  // namespace

std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format, Detail detail,
                         const reports::ResultsAnswer& answer,
                         const std::vector<reports::Block>& more) {
  const bool leaderboard = scenario.evaluation.table == scenarios::TableKind::kLeaderboard;
  if (format == "json") {
    return leaderboard ? reports::leaderboard_json(results, answer)
                       : reports::json(results, answer);
  }
  if (format == "csv") return reports::csv(results);
  if (format == "tidy") return reports::tidy_csv(results);
  // A file has all of it.
  const Detail shown = format == "table" ? detail : Detail::kAll;
  reports::Document document =
      document_in_detail(results, scenario, leaderboard, answer.text, shown);
  document.blocks.insert(document.blocks.end(), more.begin(), more.end());
  return reports::drawn_as(format, document);
}

}  // namespace simbench::app
