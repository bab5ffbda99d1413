// Exceptions of the libraries as those of simbench/errors.py, with the command line's message.
#include <exception>
#include <optional>
#include <string>

#include "app/bad_input.h"
#include "evaluation/run/evaluate.h"
#include "python/src/bindings.h"
#include "recording/recording.h"
#include "reports/text/output_file.h"

namespace py = pybind11;

namespace {

void raise(const char* name, const std::string& text) {
  const py::object type = py::module_::import("simbench.errors").attr(name);
  PyErr_SetString(type.ptr(), text.c_str());
}

// Throws what is not the bench's own, for the next translator.
void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const simbench::RecordingCancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const simbench::evaluation::EvaluationCancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const simbench::reports::OutputError& error) {
    raise("OutputError", error.what());
  } catch (const simbench::evaluation::EvaluationFailed& error) {
    raise("Error", error.what());
  } catch (const simbench::RecordingFailed& error) {
    raise("Error", error.what());
  } catch (const std::exception& error) {
    const std::optional<std::string> text = simbench::app::bad_input(error);
    if (!text) throw;
    raise("InputError", *text);
  }
}

}  // namespace

void bind_errors(pybind11::module_& module) {
  static_cast<void>(module);
  py::register_exception_translator(translate);
}
