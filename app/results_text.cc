#include "app/results_text.h"

#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"

namespace simbench::app {

std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format, const std::vector<reports::Block>& more) {
  const bool leaderboard = scenario.evaluation.table == scenarios::TableKind::kLeaderboard;
  if (format == "json") {
    return leaderboard ? reports::leaderboard_json(results) : reports::json(results);
  }
  if (format == "csv") return reports::csv(results);
  reports::Document document = leaderboard
                                   ? reports::leaderboard_document(results, scenario.summary)
                                   : reports::results_document(results, scenario.summary);
  document.blocks.insert(document.blocks.end(), more.begin(), more.end());
  return format == "markdown" ? markdown(document) : plain(document);
}

}  // namespace simbench::app
