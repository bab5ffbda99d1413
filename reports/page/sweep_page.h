// The page of a sweep, sweep.html in its folder: the answer, the response as a figure, the tables.
// It depends on the plan and the results alone: equal sweeps have equal pages.
//
//   file << sweep_html({.plan = plan, .answer = answer, .figures = figures, .blocks = blocks});
#pragma once

#include <string>
#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct SweepPage {
  const evaluation::SweepPlan& plan;
  AnswerText answer;
  std::vector<Figure> figures;  // the first one leads
  std::vector<Block> blocks;
};

std::string sweep_html(const SweepPage& page);

}  // namespace simbench::reports
