// What is left when a run or a sweep is finished: the text that is printed, and the files.
//
//   RunArchive archive(arguments);              // the run begins
//   archive.open("results/monday");             // refused before the work, not after it
//   const evaluation::Results results = evaluation::evaluate(scenario, make_source, {}, progress);
//   archive.write(results, scenario);
#ifndef SIMBENCH_APP_RESULTS_H_
#define SIMBENCH_APP_RESULTS_H_

#include <memory>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/sweep/sweep_plan.h"
#include "reports/archive/archive.h"
#include "reports/sweep/sweep_folder.h"
#include "reports/text/block.h"
#include "scenarios/scenario.h"
#include "scenarios/study.h"

namespace simbench::app {

// Results in the format that was asked for, as the run of a scenario prints them. `format`: table,
// markdown, csv or json. `more`: what else a table or Markdown is to say.
std::string results_text(const evaluation::Results& results, const scenarios::Scenario& scenario,
                         const std::string& format, const std::vector<reports::Block>& more = {});

// The result archive of a run, if one is wanted.
class RunArchive {
 public:
  // `command` as given, for the manifest; the run's time counts from here.
  explicit RunArchive(std::vector<std::string> command);
  // Where it will be; empty: nowhere. Throws reports::OutputError.
  void open(const std::string& folder);
  // False if it is wanted nowhere. Throws reports::OutputError.
  bool write(const evaluation::Results& results, const scenarios::Scenario& scenario);

 private:
  reports::Provenance provenance_;
  std::unique_ptr<reports::OutputFolder> folder_;
};

struct SweepText {
  std::string tables;     // for standard output
  std::string not_drawn;  // why there is no plot; empty where there is one
};

// Writes sweep.csv, hosts.csv, sweep.txt and, where gnuplot is, sweep.svg, and puts the log in
// order. The first of `tables` is drawn. Throws reports::OutputError.
SweepText write_sweep_results(const evaluation::SweepPlan& plan,
                              const std::vector<scenarios::StudyTable>& tables,
                              reports::SweepFolder& folder);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RESULTS_H_
