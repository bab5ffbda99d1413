// The first figure of a report: every pipeline on one logarithmic axis.
//
// A line each, in order of the median of what the results are ranked by (scoring/ranked_by.h): the
// band from 5 to 95 % over the seeds, the median, the published value or bound where there is
// one of that metric. The best pipeline, limits, references and what failed say so in words, not by
// colour alone. It is HTML and style, without a script, and as wide as the page. The first 24
// pipelines are shown.
//
//   const std::string figure = overview_html(all_results);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/scoring/results.h"

namespace simbench::reports {

// A line of the figure. The series is in milliseconds.
struct OverviewRow {
  const evaluation::Row* row = nullptr;        // of the results
  const evaluation::Series* series = nullptr;  // of the row: what is drawn
  std::optional<double> published_ms{};        // a value or a bound
  std::string word{};                          // "best", "limit", "reference", "failed" or ""
};

// In their order; none if no pipeline has a value above 0.
std::vector<OverviewRow> overview_rows(const evaluation::Results& results);

// "" if no pipeline has a value above 0.
std::string overview_html(const evaluation::Results& results);

}  // namespace simbench::reports
