// Algorithms in Python and the command line with them, for the package.
#include "python/src/algorithms.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/process.h"
#include "python/src/bindings.h"
#include "python/src/host_requests.h"
#include "python/src/python_algorithm.h"
#include "python/src/records.h"

namespace simbench::python {
namespace {

// A file of `--python FILE`, which the command line asks for while it holds no lock.
void import_algorithms(const std::string& file) {
  const py::gil_scoped_acquire gil;
  try {
    py::module_::import("simbench.__main__").attr("import_algorithms")(file);
  } catch (py::error_already_set& error) {
    const py::object exception = error.value();
    const std::string text = py::str(exception);
    throw PythonFailure(text, shared(exception));
  }
}

int command_line(std::vector<std::string> arguments) {
  const py::gil_scoped_release no_gil;
  cli::keep_freed_memory();
  std::vector<char*> argv;
  argv.reserve(arguments.size());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return run_command_line(static_cast<int>(argv.size()), argv.data(),
                          {.import_algorithms = &import_algorithms});
}

}  // namespace
}  // namespace simbench::python

void bind_algorithms(pybind11::module_& module) {
  using namespace simbench::python;
  bind_records(module);
  bind_host_port(module);
  module.def("register_device_time", &register_python_device_time);
  module.def("register_gathering", &register_python_gathering);
  module.def("register_host_sync", &register_python_host_sync);
  module.def("register_capture_alignment", &register_python_capture_alignment);
  module.def("command_line", &command_line);
}
