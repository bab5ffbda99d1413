#include "reports/results/budget_report.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "reports/results/json.h"
#include "reports/text/json_node.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Budget;
using evaluation::BudgetPart;
using evaluation::ErrorParts;
using evaluation::HostClockBudget;
using evaluation::PipelineBudget;

std::string band(const BudgetPart& part) { return time_band_text(part.p05, part.p95); }

std::string share_of(const BudgetPart& part, const BudgetPart& total) {
  const double share = part.mean / total.mean;
  return share_text(std::abs(share) < 5e-4 ? std::abs(share) : share);  // of either sign
}

void add_line(Table& table, const std::string& name, const Budget& budget, const BudgetPart& amd,
              const BudgetPart& absolute, const BudgetPart& physical) {
  table.add({name, time_text(amd.mean), band(amd), share_of(amd, budget.amd_ms.total),
             time_text(absolute.mean), band(absolute),
             share_of(absolute, budget.absolute_error_ms.total), time_text(physical.mean)});
}

Table budget_table(const Budget& budget) {
  Table table({{"stage", Align::kLeft},
               {"AMD\nmean"},
               {"AMD\n5-95 %"},
               {"AMD\nshare"},
               {"absolute error\nmean"},
               {"absolute error\n5-95 %"},
               {"absolute error\nshare"},
               {"of AMD physical\nmean"}});
  for (const evaluation::BudgetStage each : evaluation::budget_stages(budget)) {
    const auto stage = static_cast<std::size_t>(each);
    add_line(table, std::string(evaluation::stage_name(budget, each)), budget,
             budget.amd_ms.stages[stage], budget.absolute_error_ms.stages[stage],
             budget.physical_ms.stages[stage]);
  }
  add_line(table, "remainder", budget, budget.amd_ms.remainder, budget.absolute_error_ms.remainder,
           budget.physical_ms.remainder);
  add_line(table, "total", budget, budget.amd_ms.total, budget.absolute_error_ms.total,
           budget.physical_ms.total);
  return table;
}

Table host_clock_table(const HostClockBudget& budget) {
  Table table(
      {{"part", Align::kLeft}, {"gone with ideal", Align::kLeft}, {"mean"}, {"5-95 %"}, {"share"}});
  const auto add = [&](std::string_view name, std::string_view cause, const BudgetPart& part) {
    table.add({std::string(name), std::string(cause), time_text(part.mean), band(part),
               share_of(part, budget.total)});
  };
  for (std::size_t i = 0; i < evaluation::kHostClockCauseCount; ++i) {
    add(evaluation::kHostClockParts[i].name, evaluation::kHostClockParts[i].cause, budget.parts[i]);
  }
  add("algorithm", "-", budget.algorithm);
  add("total", "", budget.total);
  return table;
}

std::string budget_heading(std::string_view what, const BudgetReport& report,
                           const std::string& pipeline) {
  return fmt::format("{} of {} in {}, {}", what, pipeline,
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
         " A stage's part is its Shapley value over all worlds with some stages ideal. Parts "
         "and remainder add up to the total; a part below zero cancels others. Physical: how far "
         "apart the exposures of a pulse really were, which no clock can remove.";
}

constexpr const char* kHostClockLegend =
    "Slaves against the master. The parts are not what the algorithm reports, but what is lost in "
    "other worlds (Shapley values over 8): estimation where messages are ideal (constant and equal "
    "ways, exact stamps), staleness where oscillators are, steering where clocks are read and set "
    "exactly and at once; what is left with all three ideal is the algorithm's own.";

Block host_clock_block(const BudgetReport& report, const HostClockBudget& budget) {
  Block block{.heading = budget_heading("Host clock error", report, budget.pipeline)};
  if (budget.is_divided) {
    block.table = host_clock_table(budget);
    block.prose = {kHostClockLegend};
  }
  if (!budget.note.empty()) {
    block.prose.push_back((budget.is_divided ? "" : "Not divided: ") + budget.note + ".");
  }
  return block;
}

Json part_json(const BudgetPart& part) {
  return {{"mean", part.mean}, {"p05", part.p05}, {"p95", part.p95}, {"values", part.values}};
}

Json error_json(const Budget& budget, const ErrorParts& error) {
  Json stages = Json::array();
  for (const evaluation::BudgetStage stage : evaluation::budget_stages(budget)) {
    Json entry = {{"stage", evaluation::stage_name(budget, stage)}};
    entry.update(part_json(error.stages[static_cast<std::size_t>(stage)]));
    stages.push_back(std::move(entry));
  }
  return {{"total", part_json(error.total)},
          {"remainder", part_json(error.remainder)},
          {"stages", std::move(stages)}};
}

Json failed_json(const Budget& budget) {
  return {{"pipeline", budget.pipeline}, {"failed", budget.failed},      {"amd_of_sets", nullptr},
          {"amd_ms", nullptr},           {"absolute_error_ms", nullptr}, {"physical_ms", nullptr},
          {"host_error_ms", nullptr}};
}

Json host_clock_json(const HostClockBudget& budget) {
  if (!budget.is_divided) return {{"note", budget.note}};
  Json parts = Json::array();
  for (std::size_t i = 0; i < evaluation::kHostClockCauseCount; ++i) {
    Json entry = {{"part", evaluation::kHostClockParts[i].name},
                  {"cause", evaluation::kHostClockParts[i].cause}};
    entry.update(part_json(budget.parts[i]));
    parts.push_back(std::move(entry));
  }
  return {{"note", budget.note.empty() ? Json(nullptr) : Json(budget.note)},
          {"total", part_json(budget.total)},
          {"algorithm", part_json(budget.algorithm)},
          {"parts", std::move(parts)}};
}

}  // namespace

Document budget_document(const BudgetReport& report) {
  Document document{.head = scenarios::derivation_lines(report.derivation)};
  for (const PipelineBudget& budget : report.budgets) {
    const Budget& stages = budget.stages;
    if (!stages.failed.empty()) {
      document.blocks.push_back(
          {.heading = budget_heading("Error budget", report, stages.pipeline),
           .prose = {fmt::format("{} failed: {}.", stages.pipeline, stages.failed)}});
      continue;
    }
    document.blocks.push_back({.heading = budget_heading("Error budget", report, stages.pipeline),
                               .table = budget_table(stages),
                               .prose = {budget_legend(stages)}});
    document.blocks.push_back(host_clock_block(report, budget.host_clock));
  }
  return document;
}

std::string budget_json(const BudgetReport& report) {
  Json root = new_document();
  root["scenario"] = report.scenario;
  state_derivation(report.derivation, root);
  root["seeds"] = {{"first", report.first_seed}, {"count", report.seeds}};
  root["budgets"] = Json::array();
  for (const auto& [stages, host_clock] : report.budgets) {
    if (!stages.failed.empty()) {
      root["budgets"].push_back(failed_json(stages));
      continue;
    }
    root["budgets"].push_back({{"pipeline", stages.pipeline},
                               {"amd_of_sets", stages.amd_of_sets},
                               {"amd_ms", error_json(stages, stages.amd_ms)},
                               {"absolute_error_ms", error_json(stages, stages.absolute_error_ms)},
                               {"physical_ms", error_json(stages, stages.physical_ms)},
                               {"host_error_ms", host_clock_json(host_clock)}});
  }
  return file_text(root);
}

}  // namespace simbench::reports
