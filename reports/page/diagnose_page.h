// The page of `simbench diagnose --html`: the answer, how each camera's phase moves, the tables.
//
//   file << diagnose_html({.diagnosis = diagnosis, .inputs = {"rig.csv"},
//                          .command = {"simbench", "diagnose", "rig.csv"}});
#ifndef SIMBENCH_REPORTS_PAGE_DIAGNOSE_PAGE_H_
#define SIMBENCH_REPORTS_PAGE_DIAGNOSE_PAGE_H_

#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"

namespace simbench::reports {

struct DiagnosePage {
  const evaluation::Diagnosis& diagnosis;
  std::vector<std::string> inputs;   // as the user stated them
  std::vector<std::string> command;  // argv
};

std::string diagnose_html(const DiagnosePage& page);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_DIAGNOSE_PAGE_H_
