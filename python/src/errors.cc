// Exceptions of the libraries as those of simbench/errors.py, with the command line's message.
#include <exception>
#include <optional>
#include <string>

#include "app/bad_input.h"
#include "evaluation/run/evaluate.h"
#include "python/src/bindings.h"
#include "python/src/python_algorithm.h"
#include "recording/recording.h"
#include "reports/text/output_file.h"

namespace py = pybind11;

using simbench::python::python_exception_in;
using simbench::python::SharedObject;

namespace {

// `cause`: the exception in an algorithm of the user's; null: none.
void raise(const char* name, const std::string& text, const SharedObject& cause = nullptr) {
  const py::object type = py::module_::import("simbench.errors").attr(name);
  const py::object error = type(text);
  if (cause)
    PyException_SetCause(error.ptr(),
                         py::reinterpret_borrow<py::object>(cause.get()).release().ptr());
  PyErr_SetObject(type.ptr(), error.ptr());
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
    raise("InputError", *text, python_exception_in(error));
  }
}

}  // namespace

void bind_errors(pybind11::module_& module) {
  static_cast<void>(module);
  py::register_exception_translator(translate);
}
