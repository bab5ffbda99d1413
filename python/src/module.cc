#include <pybind11/pybind11.h>

#include <string>

#include "app/program_pipelines.h"
#include "python/src/bindings.h"
#include "python/src/command.h"
#include "recording/version.h"

PYBIND11_MODULE(_simbench, module) {
  module.doc() = "What the package simbench stands on; use the package.";
  module.attr("version") = std::string(simbench::version());
  module.attr("commit") = std::string(simbench::commit());
  // Real programs find the preloaded library in the package's folder.
  module.def("use_programs", [](const std::string& folder) {
    simbench::app::use_programs({.library_folder = folder});
  });
  bind_errors(module);
  bind_rows(module);
  bind_scenarios(module);
  bind_results(module);
  bind_recordings(module);
  bind_clocks(module);
  bind_algorithms(module);
  bind_command(module);
}
