#include "reports/results/budget_report.h"

#include <fmt/format.h>

#include <cmath>

#include "recording/version.h"
#include "reports/results/derivation_json.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Budget;
using evaluation::BudgetPart;
using evaluation::ErrorParts;

std::string band(const BudgetPart& part) {
  if (std::isnan(part.p05)) return "-";
  return fmt::format("[{}, {}]", number_text(part.p05), number_text(part.p95));
}

std::string share_of(const BudgetPart& part, const ErrorParts& error) {
  const double share = part.mean / error.total.mean;
  return share_text(std::abs(share) < 5e-4 ? std::abs(share) : share);  // of either sign
}

void add_line(Table& table, const std::string& name, const Budget& budget, const BudgetPart& amd,
              const BudgetPart& absolute, const BudgetPart& physical) {
  table.add({name, number_text(amd.mean), band(amd), share_of(amd, budget.amd_ms),
             number_text(absolute.mean), band(absolute),
             share_of(absolute, budget.absolute_error_ms), number_text(physical.mean)});
}

Table budget_table(const Budget& budget) {
  Table table({{"stage", Align::kLeft},
               {"AMD\nmean ms"},
               {"AMD\n5-95 %"},
               {"AMD\nshare"},
               {"absolute error\nmean ms"},
               {"absolute error\n5-95 %"},
               {"absolute error\nshare"},
               {"of AMD physical\nmean ms"}});
  for (std::size_t stage = 0; stage < evaluation::kStageCount; ++stage) {
    add_line(table, std::string(evaluation::kStageNames[stage]), budget,
             budget.amd_ms.stages[stage], budget.absolute_error_ms.stages[stage],
             budget.physical_ms.stages[stage]);
  }
  add_line(table, "remainder", budget, budget.amd_ms.remainder, budget.absolute_error_ms.remainder,
           budget.physical_ms.remainder);
  add_line(table, "total", budget, budget.amd_ms.total, budget.absolute_error_ms.total,
           budget.physical_ms.total);
  return table;
}

std::string budget_heading(const BudgetReport& report, const Budget& budget) {
  return fmt::format("Error budget of {} in {}, {}", budget.pipeline,
                     scenarios::named(report.scenario, report.derivation),
                     counted_seeds(report.first_seed, report.seeds));
}

std::string budget_legend(const Budget& budget) {
  const std::string over =
      budget.amd_of_sets
          ? "Errors are over the sets that gathering emits."
          : "In some of the worlds gathering finds no set, so errors are over the true pulses and "
            "gathering has no part in them.";
  return over +
         " A stage's part is its Shapley value over all 128 worlds with some stages ideal. Parts "
         "and remainder add up to the total; a part below zero cancels others. Physical: how far "
         "apart the exposures of a pulse really were, which no clock can remove.";
}

Json part_json(const BudgetPart& part) {
  return {{"mean", part.mean}, {"p05", part.p05}, {"p95", part.p95}, {"values", part.values}};
}

Json error_json(const ErrorParts& error) {
  Json stages = Json::array();
  for (std::size_t stage = 0; stage < evaluation::kStageCount; ++stage) {
    Json entry = {{"stage", evaluation::kStageNames[stage]}};
    entry.update(part_json(error.stages[stage]));
    stages.push_back(std::move(entry));
  }
  return {{"total", part_json(error.total)},
          {"remainder", part_json(error.remainder)},
          {"stages", std::move(stages)}};
}

}  // namespace

Document budget_document(const BudgetReport& report) {
  Document document{.head = scenarios::derivation_lines(report.derivation)};
  for (const Budget& budget : report.budgets) {
    document.blocks.push_back({.heading = budget_heading(report, budget),
                               .table = budget_table(budget),
                               .prose = {budget_legend(budget)}});
  }
  return document;
}

std::string budget_json(const BudgetReport& report) {
  Json root = {{"schema_version", 1},
               {"version", version()},
               {"commit", commit()},
               {"scenario", report.scenario}};
  state_derivation(report.derivation, root);
  root["seeds"] = {{"first", report.first_seed}, {"count", report.seeds}};
  root["budgets"] = Json::array();
  for (const Budget& budget : report.budgets) {
    root["budgets"].push_back({{"pipeline", budget.pipeline},
                               {"amd_of_sets", budget.amd_of_sets},
                               {"amd_ms", error_json(budget.amd_ms)},
                               {"absolute_error_ms", error_json(budget.absolute_error_ms)},
                               {"physical_ms", error_json(budget.physical_ms)}});
  }
  return file_text(root);
}

}  // namespace simbench::reports
