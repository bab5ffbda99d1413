#include <pybind11/pybind11.h>

#include <string>

#include "app/program_pipelines.h"
#include "python/src/bindings.h"
#include "recording/version.h"

PYBIND11_MODULE(_simbench, module) {
  module.doc() = "What the package simbench stands on; use the package.";
  module.attr("version") = std::string(simbench::version());
  module.attr("commit") = std::string(simbench::commit());
  simbench::app::use_programs();
  simbench::python::bind_results(module);
  simbench::python::bind_algorithms(module);
}
