#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

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

py::list describe(const std::string& scenario) {
  py::list lines;
  for (const auto& line :
       simbench::scenarios::describe(simbench::scenarios::load_scenario(scenario))) {
    lines.append(py::dict(py::arg("pointer") = line.pointer, py::arg("value") = line.value,
                          py::arg("unit") = line.unit, py::arg("meaning") = line.meaning,
                          py::arg("source") = line.source));
  }
  return lines;
}

// The pipelines of a scenario with these changes: name, host_sync, capture_alignment (may be
// empty), device_time, gathering.
py::list pipelines_of(const std::string& scenario,
                      const std::vector<std::pair<std::string, std::string>>& sets) {
  std::vector<simbench::scenarios::Override> overrides;
  overrides.reserve(sets.size());
  for (const auto& [pointer, value] : sets) overrides.push_back({pointer, value});
  py::list all;
  for (const auto& pipeline : simbench::scenarios::load_scenario(scenario, overrides).pipelines) {
    all.append(py::make_tuple(pipeline.name, pipeline.host_sync, pipeline.capture_alignment,
                              pipeline.device_time, pipeline.gathering));
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
  module.def("pipelines_of", &pipelines_of);
  module.def("counts", &counts);
  module.def("set_page_width", &simbench::reports::set_page_width);
}
