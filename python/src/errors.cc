// Exceptions of the libraries as those of simbench/errors.py, with the command line's message.
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "app/bad_input.h"
#include "evaluation/run/evaluate.h"
#include "python/src/binding.h"
#include "python/src/python_algorithm.h"
#include "recording/recording.h"
#include "reports/text/output_file.h"

namespace simbench::python {
namespace {

// `cause`: the exception in an algorithm of the user's; null: none.
void raise(const char* name, const std::string& text, const SharedObject& cause = nullptr) {
  const Object type = imported("simbench.errors").attribute(name);
  const Object error = type(text);
  if (cause) PyException_SetCause(error.get(), Object::borrowed(cause.get()).release());
  PyErr_SetObject(type.get(), error.get());
}

// An exception that is not the bench's own.
void raise_plain(const std::exception& error) {
  PyObject* type = PyExc_RuntimeError;
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) type = PyExc_MemoryError;
  if (dynamic_cast<const std::out_of_range*>(&error) != nullptr) type = PyExc_IndexError;
  if (dynamic_cast<const std::invalid_argument*>(&error) != nullptr) type = PyExc_ValueError;
  PyErr_SetObject(type, to_python(error.what()).get());
}

void raise_one(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const PythonError& error) {
    error.restore();
  } catch (const ConversionError& error) {
    PyErr_SetObject(PyExc_TypeError, to_python(error.what()).get());
  } catch (const RecordingCancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const evaluation::EvaluationCancelled&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const reports::OutputError& error) {
    raise("OutputError", error.what());
  } catch (const evaluation::EvaluationFailed& error) {
    raise("Error", error.what());
  } catch (const RecordingFailed& error) {
    raise("Error", error.what());
  } catch (const std::exception& error) {
    const std::optional<std::string> text = app::bad_input(error);
    if (text) {
      raise("InputError", *text, python_exception_in(error));
    } else {
      raise_plain(error);
    }
  }
}

}  // namespace

void set_python_error(const std::exception_ptr& thrown) {
  try {
    raise_one(thrown);
  } catch (const PythonError& error) {  // raised by simbench.errors
    error.restore();
  } catch (...) {
    PyErr_SetString(PyExc_RuntimeError, "an error that has no text");
  }
}

}  // namespace simbench::python
