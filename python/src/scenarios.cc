#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/scoring/metrics.h"
#include "python/src/bindings.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace py = pybind11;

namespace {

py::list list_scenarios() {
  py::list all;
  for (const auto& each : simbench::scenarios::builtin_scenarios()) {
    all.append(py::dict(py::arg("scenario") = each.name, py::arg("summary") = each.summary));
  }
  return all;
}

using Sets = std::vector<std::pair<std::string, std::string>>;

std::vector<simbench::scenarios::Override> overrides_of(const Sets& sets) {
  std::vector<simbench::scenarios::Override> overrides;
  overrides.reserve(sets.size());
  for (const auto& [pointer, value] : sets) overrides.push_back({pointer, value});
  return overrides;
}

py::list describe(const std::string& scenario, const Sets& sets) {
  py::list lines;
  for (const auto& line : simbench::scenarios::describe(
           simbench::scenarios::load_scenario(scenario, overrides_of(sets)))) {
    lines.append(py::dict(py::arg("pointer") = line.pointer, py::arg("value") = line.value,
                          py::arg("unit") = line.unit, py::arg("meaning") = line.meaning,
                          py::arg("source") = line.source));
  }
  return lines;
}

// The stages of a pipeline, in order: name and whether a pipeline may lack it.
py::dict stages() {
  py::dict all;
  for (const simbench::StageInfo& stage : simbench::kPipelineStages)
    all[stage.name] = stage.may_be_absent;
  return all;
}

// The pipelines of a scenario with these changes: name, and the algorithm of each stage that it
// has.
py::list pipelines_of(const std::string& scenario, const Sets& sets) {
  py::list all;
  for (const auto& pipeline :
       simbench::scenarios::load_scenario(scenario, overrides_of(sets)).pipelines) {
    py::dict each;
    each["name"] = pipeline.name;
    for (const simbench::StageInfo& stage : simbench::kPipelineStages) {
      const std::string& algorithm = simbench::at_stage(pipeline, stage.id);
      if (!algorithm.empty()) each[stage.name] = algorithm;
    }
    all.append(each);
  }
  return all;
}

// The metrics that are whole numbers.
py::list counts() {
  py::list names;
  for (const auto& metric : simbench::evaluation::metrics()) {
    if (metric.is_count()) names.append(metric.id);
  }
  return names;
}

}  // namespace

void bind_scenarios(pybind11::module_& module) {
  module.def("list_scenarios", &list_scenarios);
  module.def("describe", &describe);
  module.def("stages", &stages);
  module.def("pipelines_of", &pipelines_of);
  module.def("counts", &counts);
  module.def("set_page_width", &simbench::reports::set_page_width);
}
