#include "app/results_text.h"

#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/table.h"

namespace simbench::app {

std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format) {
  const std::string& summary = scenario.summary;
  if (scenario.evaluation.table == "leaderboard") {
    if (format == "json") return reports::leaderboard_json(results);
    if (format == "markdown") return reports::leaderboard_markdown(results, summary);
    if (format == "table") return reports::leaderboard_table(results, summary);
  }
  if (format == "json") return reports::json(results);
  if (format == "csv") return reports::csv(results);
  if (format == "markdown") return reports::markdown(results, summary);
  return reports::table(results, summary);
}

}  // namespace simbench::app
