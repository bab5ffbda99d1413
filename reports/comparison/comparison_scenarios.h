// Where two resolved scenarios differ, divided into what makes their results incomparable and what
// is under test.
//
// The world is what a pipeline is put into: everything but the parameters of the algorithms, the
// pipelines, published values and the scenario's words about itself. Numbers of different worlds
// say nothing about the algorithms. Algorithms may differ: that is what comparisons are for.
//
//   const ScenarioDifferences d = compare_scenarios(a.scenario_json, b.scenario_json);
//   if (!d.world.empty()) refuse(d.world);
#ifndef SIMBENCH_REPORTS_COMPARISON_COMPARISON_SCENARIOS_H_
#define SIMBENCH_REPORTS_COMPARISON_COMPARISON_SCENARIOS_H_

#include <string>
#include <vector>

namespace simbench::reports {

// "/network/latency_fixed_ms: 0.1 against 0.2", in alphabetical order. Pipelines are told by name:
// "/pipelines/oracle/device_time"; one that only one scenario has is no difference.
struct ScenarioDifferences {
  std::vector<std::string> world;
  std::vector<std::string> algorithms;
};

// The texts of two resolved scenarios; JSON, or this throws scenarios::InputError.
ScenarioDifferences compare_scenarios(const std::string& a, const std::string& b);

// Same for equal content, whatever the spacing and the order of members: a UUID of version 5
// (SHA-1) of any JSON text.
std::string digest_of_json(const std::string& text);

// The first few of many, in one line: "x; y; and 7 more".
std::string first_few(const std::vector<std::string>& differences);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_COMPARISON_SCENARIOS_H_
