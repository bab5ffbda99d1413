// Results for people: what `simbench run` prints and what the page of the report shows of a run.
//
// The columns are those of evaluation::metrics(): a metric that names its table stands in it.
//
// A block each, with a row per pipeline: the paper's metrics beside the published values, and what
// only a bench with true time can tell; a third about the gathered sets if the pipelines gather in
// different ways. Rows that are not of a simulation say what ground truth they rest on;
// "unverified" are those without (evaluation/scoring/unverified_scores.h). Below them what went
// wrong, if anything, a legend that a newcomer can start from, the paper's claims with the fraction
// of seeds in which each holds, and what the run cost. About 145 columns wide. Source of the
// definitions: docs/design.md section 8.
//
//   std::cout << plain(results_document(results, scenario.summary));
#ifndef SIMBENCH_REPORTS_RESULTS_RESULTS_DOCUMENT_H_
#define SIMBENCH_REPORTS_RESULTS_RESULTS_DOCUMENT_H_

#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

// `summary` is the scenario's own line about itself; it says where a scenario is a fit.
Document results_document(const evaluation::Results& results, const std::string& summary);

// The columns of a metric in a table of rows: its value and, if it has a heading, its band.
std::vector<Field<evaluation::Row>> metric_fields(const evaluation::Metric& metric);

// What gathering made of the stamps: a line per pipeline, for policies beside each other.
Table sets_table(const std::vector<const evaluation::Row*>& rows);
// What its columns mean.
std::vector<std::string> sets_legend(const evaluation::Results& results);

// What unequal links cost two-way methods; empty if they are equal.
std::string asymmetry_line(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_RESULTS_DOCUMENT_H_
