// A gate's report as JUnit XML, which CI services show beside a change: a suite for the gate, a
// case for each metric of each pipeline, a failure with its numbers and the commands that repeat
// it.
//
// There is no standard; written is the part that GitLab, Jenkins and the common GitHub actions
// read: testsuites, testsuite, testcase (classname, name, time), failure (message, text).
#ifndef SIMBENCH_REPORTS_COMPARISON_JUNIT_H_
#define SIMBENCH_REPORTS_COMPARISON_JUNIT_H_

#include <string>
#include <string_view>

#include "reports/comparison/gate.h"

namespace simbench::reports {

std::string gate_junit(const GateReport& report);

// Text for an attribute or an element of XML 1.0: what it cannot hold is a question mark.
std::string xml_text(std::string_view text);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_JUNIT_H_
