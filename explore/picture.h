// What the page shows of one state, as JSON with parts of a page in it: the answer, the overview,
// the tables, the figures. All of it is what reports of the same results show.
//
//   use(picture_json(results, world, answer).dump());
#pragma once

#include <string>
#include <vector>

#include "app/figure_source.h"
#include "evaluation/scoring/results.h"
#include "reports/archive/archive.h"
#include "reports/results/results_answer.h"
#include "reports/text/json_node.h"
#include "scenarios/scenario.h"

namespace simbench::explore {

// {"scenario": "18cam_6host_45fps (changed)", "summary", "answer": null or {"lead", "lines"},
//  "best": a pipeline or null, "pipelines": those that have a row, "overview", "table": HTML,
//  "warnings": [...]}
reports::Json picture_json(const evaluation::Results& results, const scenarios::Scenario& scenario,
                           const reports::ResultsAnswer& answer);

// All tables of the results, as HTML.
std::string tables_html(const evaluation::Results& results, const scenarios::Scenario& scenario);

// The results as an archive, as figures and comparisons take it; `name`: what they call it.
reports::Archive archive_of(const evaluation::Results& results, const scenarios::Scenario& scenario,
                            const std::string& name);

// The second against the first, seed by seed: {"answer": as above, "tables": HTML, "data":
// figures_json()}. Throws scenarios::InputError where they cannot be compared.
reports::Json comparison_of(const reports::Archive& a, const reports::Archive& b);

}  // namespace simbench::explore
