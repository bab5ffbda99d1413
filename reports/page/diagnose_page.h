// The page of `simbench diagnose --html`: the answer, how each camera's phase moves, the tables.
//
//   file << diagnose_html({.diagnosis = diagnosis, .inputs = {"rig.csv"},
//                          .command = {"simbench", "diagnose", "rig.csv"}});
#pragma once

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
