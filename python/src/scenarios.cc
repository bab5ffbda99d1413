#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/scoring/metrics.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/run.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench::python {
namespace {

std::vector<scenarios::Override> overrides_of(const Sets& sets) {
  std::vector<scenarios::Override> overrides;
  overrides.reserve(sets.size());
  for (const auto& [pointer, value] : sets) overrides.push_back({pointer, value});
  return overrides;
}

std::vector<Object> list_scenarios() {
  std::vector<Object> all;
  for (const auto& each : scenarios::builtin_scenarios()) {
    all.push_back(dict({{"scenario", each.name}, {"summary", each.summary}}));
  }
  return all;
}

std::vector<Object> describe(const std::string& scenario, const Sets& sets) {
  std::vector<Object> lines;
  for (const auto& line :
       scenarios::describe(scenarios::load_scenario(scenario, overrides_of(sets)))) {
    lines.push_back(dict({{"pointer", line.pointer},
                          {"value", line.value},
                          {"unit", line.unit},
                          {"meaning", line.meaning},
                          {"source", line.source}}));
  }
  return lines;
}

// The stages of a pipeline, in order: name and whether a pipeline may lack it.
Object stages() {
  Object all = dict();
  for (const StageInfo& stage : kPipelineStages) all.set(stage.name, stage.may_be_absent);
  return all;
}

// The pipelines of a scenario with these changes: name, and the algorithm of each stage that it
// has.
std::vector<Object> pipelines_of(const std::string& scenario, const Sets& sets) {
  std::vector<Object> all;
  for (const auto& pipeline : scenarios::load_scenario(scenario, overrides_of(sets)).pipelines) {
    Object each = dict({{"name", pipeline.name}});
    for (const StageInfo& stage : kPipelineStages) {
      const std::string& algorithm = at_stage(pipeline, stage.id);
      if (!algorithm.empty()) each.set(stage.name, algorithm);
    }
    all.push_back(each);
  }
  return all;
}

// The metrics that are whole numbers.
std::vector<std::string> counts() {
  std::vector<std::string> names;
  for (const auto& metric : evaluation::metrics()) {
    if (metric.is_count()) names.emplace_back(metric.id);
  }
  return names;
}

}  // namespace

void bind_scenarios(const Object& module) {
  add_functions(
      module,
      {function("list_scenarios", callable<&list_scenarios>),
       function("describe", callable<&describe>), function("stages", callable<&stages>),
       function("pipelines_of", callable<&pipelines_of>), function("counts", callable<&counts>),
       function("set_page_width", callable<&reports::set_page_width>)});
}

}  // namespace simbench::python
