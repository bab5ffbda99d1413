// Runs what the paper measured, at both of its rates, and writes it beside what is printed.
//
//   PaperFolder folder("results/paper", arguments);  // before the work: refuses what cannot be
//   reports::PaperResults results = run_paper({.seeds = 200}, nullptr);
//   folder.write(results, nullptr);
//
// The folder (-o) appears whole or not at all (reports/text/output_file.h):
//
//   manifest.json           version, commit, command, start and end
//   paper.html              one self-contained page (reports/paper/paper_page.h)
//   paper.txt, paper.json   reports/paper/paper_document.h
//   18cam_6host_15fps/, 18cam_6host_45fps/   the result archive of each rate
//                           (reports/archive/archive.h), for report, figure and compare
//
// Cost: a run of each pipeline of both scenarios for every seed, and some 20 runs for the figures.
//
// Errors: those of evaluation::evaluate() and archive_figures(), reports::OutputError.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "reports/archive/archive.h"
#include "reports/paper/paper_document.h"
#include "reports/text/output_file.h"

namespace simbench::app {

struct PaperOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 200;
  unsigned jobs = 0;  // threads; 0: one for every core
};

// Both rates, without Table 4 and without figures. `progress` may be null.
reports::PaperResults run_paper(const PaperOptions& options, const evaluation::Progress& progress);

class PaperFolder {
 public:
  // `command`: argv.
  PaperFolder(const std::string& path, std::vector<std::string> command);

  // Draws the paper's figures into `results`, each of the world that the catalogue has for it, at
  // the first seed, and writes all of it.
  // `progress` may be null.
  void write(reports::PaperResults& results, const evaluation::Progress& progress);

 private:
  std::string path_;
  reports::Provenance provenance_;
  reports::OutputFolder output_;
};

}  // namespace simbench::app
