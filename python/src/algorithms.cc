// Algorithms in Python and the command line with them, for the package.
#include "python/src/algorithms.h"

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/process.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/host_requests.h"
#include "python/src/python_algorithm.h"
#include "python/src/records.h"

namespace simbench::python {
namespace {

// A file of `--python FILE`, which the command line asks for while it holds no lock.
void import_algorithms(const std::string& file) {
  const WithGil gil;
  try {
    imported("simbench.__main__").attribute("import_algorithms")(file);
  } catch (const PythonError& error) {
    const Object text = Object::owned(PyObject_Str(error.exception().get()));
    throw PythonFailure(text.as<std::string>(), shared(error.exception()));
  }
}

int command_line(std::vector<std::string> arguments) {
  const WithoutGil no_gil;
  cli::keep_freed_memory();
  std::vector<char*> argv;
  argv.reserve(arguments.size());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return run_command_line(static_cast<int>(argv.size()), argv.data(),
                          {.import_algorithms = &import_algorithms});
}

}  // namespace

void bind_algorithms(const Object& module) {
  bind_records(module);
  bind_host_port(module);
  add_functions(
      module, {function("register_device_time", callable<&register_python_device_time>),
               function("register_gathering", callable<&register_python_gathering>),
               function("register_host_sync", callable<&register_python_host_sync>),
               function("register_capture_alignment", callable<&register_python_capture_alignment>),
               function("command_line", callable<&command_line>)});
}

}  // namespace simbench::python
