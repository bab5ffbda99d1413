// What is left when all runs of a sweep are finished: its files, and the text that is printed.
#ifndef SIMBENCH_CLI_SWEEP_RESULTS_H_
#define SIMBENCH_CLI_SWEEP_RESULTS_H_

#include <string>
#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "reports/sweep/sweep_folder.h"
#include "scenarios/study.h"

namespace simbench::cli {

// Writes sweep.csv, hosts.csv, sweep.txt and, where gnuplot is, sweep.svg, and puts the log in
// order. The first of `tables` is drawn. Returns the tables for standard output. Throws
// reports::OutputError.
std::string write_sweep_results(const evaluation::SweepPlan& plan,
                                const std::vector<scenarios::StudyTable>& tables,
                                reports::SweepFolder& folder);

// All studies by name, with the question that each answers.
std::string study_list();

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_SWEEP_RESULTS_H_
