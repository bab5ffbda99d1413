#include "app/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "app/interrupt.h"
#include "evaluation/answer/answer.h"
#include "evaluation/levers/levers.h"
#include "scenarios/loader.h"

namespace simbench::app {

using evaluation::Results;
using evaluation::Row;
using scenarios::Scenario;

void rank_by(const std::string& metric, Results& results) {
  if (metric.empty()) return;
  const auto has_value = [&results](const std::string& id) {
    return std::ranges::any_of(results.rows, [&id](const Row& row) {
      return !std::isnan(evaluation::metric(id).series(row).median);
    });
  };
  if (!has_value(metric)) {
    std::vector<std::string> known = evaluation::ranking_metrics();
    std::erase_if(known, [&](const std::string& id) { return !has_value(id); });
    throw scenarios::InputError(
        fmt::format("--rank-by: found '{}', of which these results have no value, allowed: {}",
                    metric, fmt::join(known, ", ")));
  }
  results.ranked_by = evaluation::ranked_by_named(metric).value();
}

reports::ResultsAnswer run_answer(const Results& results, const Scenario& scenario,
                                  const AnswerOptions& options,
                                  const evaluation::Progress& progress) {
  const std::vector<std::string> warnings = scenarios::warnings(scenario);
  const Row* const best = evaluation::best_of(results);
  std::optional<evaluation::Levers> levers;
  if (best != nullptr && options.levers) {
    levers = evaluation::find_levers(scenario, results, *best, simulated_world,
                                     {.jobs = options.jobs}, progress);
  }
  return reports::results_answer(results, std::move(levers), warnings);
}

}  // namespace simbench::app
