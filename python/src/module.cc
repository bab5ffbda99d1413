#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>

#include "app/program_pipelines.h"
#include "python/src/bindings.h"
#include "recording/version.h"

PYBIND11_MODULE(_simbench, module) {
  module.doc() = "What the package simbench stands on; use the package.";
  module.attr("version") = std::string(simbench::version());
  module.attr("commit") = std::string(simbench::commit());
  const auto file = module.attr("__spec__").attr("origin").cast<std::string>();
  simbench::app::use_programs(
      {.library_folder = std::filesystem::path(file).parent_path().string()});
  bind_errors(module);
  bind_rows(module);
  bind_scenarios(module);
  bind_results(module);
  bind_recordings(module);
  bind_clocks(module);
  bind_algorithms(module);
}
