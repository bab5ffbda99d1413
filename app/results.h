// The files of a run or a sweep, and what sweeps and runs of clocks print.
//
//   RunArchive archive(arguments);              // the run begins
//   archive.open("results/monday");             // throws before the work, not after it
//   const evaluation::Results results = evaluation::evaluate(scenario, make_source, {}, progress);
//   archive.write(results, scenario);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/scoring/results.h"
#include "evaluation/sweep/sweep_plan.h"
#include "reports/archive/archive.h"
#include "reports/sweep/sweep_folder.h"
#include "reports/text/block.h"
#include "scenarios/scenario.h"
#include "scenarios/study.h"

namespace simbench::app {

// The results as `simbench clocks` prints them; `format` as in app/results_text.h.
std::string clock_text(const evaluation::ClockResults& results, const scenarios::Scenario& scenario,
                       const std::string& format);

// The result archive of a run; none if no folder is opened.
class RunArchive {
 public:
  // `command` as given, for the manifest; the run's time counts from here.
  explicit RunArchive(std::vector<std::string> command);
  // Empty: no archive. Throws reports::OutputError.
  void open(const std::string& folder);
  // False if there is no folder. Throws reports::OutputError.
  // `answer` as of reports::write_archive().
  bool write(const evaluation::Results& results, const scenarios::Scenario& scenario,
             const reports::ResultsAnswer* answer = nullptr);
  bool write(const evaluation::ClockResults& results, const scenarios::Scenario& scenario);

 private:
  reports::Provenance provenance_;
  std::unique_ptr<reports::OutputFolder> folder_;
};

struct SweepText {
  reports::Document document{};  // the answer and the tables, as the command prints them
  std::string not_drawn;         // why there is no plot; empty where there is one
  bool has_failed = false;       // a pipeline whose real programs ended too early in every run
};

// Writes sweep.csv, hosts.csv, sweep.txt, sweep.html, answer.json and, if gnuplot is installed,
// sweep.svg with the figure of the first of `tables`; puts the log in order. Throws
// reports::OutputError.
SweepText write_sweep_results(const evaluation::SweepPlan& plan,
                              const std::vector<scenarios::StudyTable>& tables,
                              reports::SweepFolder& folder);

}  // namespace simbench::app
