#include <exception>
#include <string>
#include <vector>

#include "app/own_program.h"
#include "app/program_pipelines.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "recording/version.h"

namespace simbench::python {
namespace {

PyModuleDef definition = {.m_base = PyModuleDef_HEAD_INIT,
                          .m_name = "_simbench",
                          .m_doc = "What the package simbench stands on; use the package.",
                          .m_size = -1,  // not in subinterpreters: its classes are the process's
                          .m_methods = nullptr,
                          .m_slots = nullptr,
                          .m_traverse = nullptr,
                          .m_clear = nullptr,
                          .m_free = nullptr};

// How this program is started again: the interpreter, and the words before the arguments. Real
// programs find the preloaded library in the package's folder.
void use_programs(const std::string& interpreter, const std::vector<std::string>& leading,
                  const std::string& folder) {
  app::set_own_program({.path = interpreter, .leading = leading, .library_folder = folder});
  app::use_programs();
}

Object made_module() {
  Object module = Object::owned(PyModule_Create(&definition));
  PyModule_AddStringConstant(module.get(), "version", std::string(version()).c_str());
  PyModule_AddStringConstant(module.get(), "commit", std::string(commit()).c_str());
  add_functions(module, {function("use_programs", callable<&use_programs>)});
  bind_rows(module);
  bind_scenarios(module);
  bind_results(module);
  bind_recordings(module);
  bind_clocks(module);
  bind_algorithms(module);
  bind_command(module);
  return module;
}

}  // namespace
}  // namespace simbench::python

PyMODINIT_FUNC PyInit__simbench() {
  using namespace simbench::python;
  try {
    return made_module().release();
  } catch (...) {
    set_python_error(std::current_exception());
    return nullptr;
  }
}
