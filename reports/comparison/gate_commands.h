// The commands that repeat what a gate saw.
#ifndef SIMBENCH_REPORTS_COMPARISON_GATE_COMMANDS_H_
#define SIMBENCH_REPORTS_COMPARISON_GATE_COMMANDS_H_

#include <string>
#include <vector>

#include "reports/comparison/gate.h"

namespace simbench::reports {

// The run (as its manifest has it; of a results.json alone as far as that tells), then the gate.
std::vector<std::string> gate_commands(const Archive& result, const Baseline& baseline,
                                       GateMode mode);

// A command as a POSIX shell takes it.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_GATE_COMMANDS_H_
