// What a run prints.
//
//   const reports::ResultsAnswer answer = run_answer(results, scenario, {}, nullptr);
//   use(results_text(results, scenario, "table", Detail::kScreen, answer));
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/results/results_answer.h"
#include "reports/text/block.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// How much of the results a reader wants: the answer, a screen, or all of it.
enum class Detail : std::uint8_t { kAnswer, kScreen, kAll };

// The results as `simbench run` prints them. `format`: table, markdown, latex, csv, tidy or json;
// the detail is that of a table, Markdown and LaTeX have all. `answer`: what these begin
// with, and what JSON has. `more`: blocks that follow.
std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format, Detail detail,
                         const reports::ResultsAnswer& answer,
                         const std::vector<reports::Block>& more = {});

}  // namespace simbench::app
