// Error budgets as text, Markdown or JSON: the part of each stage in a pipeline's error, and what
// the error of its host clocks comes from.
//
// JSON: {"schema_version", "version", "commit", "scenario" and what it rests on
// (reports/results/json.h), "seeds", "budgets": [{"pipeline",
// "amd_of_sets", "amd_ms": {"total", "remainder", "stages": [{"stage", "mean", "p05", "p95",
// "values"}]}, "absolute_error_ms", "physical_ms", "host_error_ms": {"note", "total", "algorithm",
// "parts": [{"part", "cause", "mean", ...}]}}]}; "host_error_ms" has the note alone where it is not
// divided, and what does not exist is null.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/budget/pipeline_budget.h"
#include "reports/text/block.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

struct BudgetReport {
  std::string scenario;
  scenarios::Derivation derivation{};  // of that scenario
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::vector<evaluation::PipelineBudget> budgets;
};

Document budget_document(const BudgetReport& report);
std::string budget_json(const BudgetReport& report);

}  // namespace simbench::reports
