// What the algorithms in Python share: their objects, their errors, their definition.
//
// Algorithms run on many threads. Each enters Python for a block of frames or a step of a
// coroutine and leaves it again; no C++ code waits, and no coroutine is suspended, while it holds
// the interpreter's lock (GIL).
//
// A definition is what a decorator of simbench/algorithms.py has found out about a class or a
// function. Registering a name again takes the place of the former definition; runs under way keep
// theirs.
//
// Errors: what Python raises, and what a class returns that the bench cannot use, is a
// PythonFailure, one line that names class, file and line; evaluation adds pipeline and seed. It is
// an InputError, as the mistake is the user's, and ends the run.
//
//   const WithGil gil;
//   const Object made = make_instance(algorithm, keywords_of(algorithm, parameters));
//   if (result == nullptr) throw_python_failure(algorithm);
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/parameters.h"
#include "algorithms/registry.h"
#include "python/src/object.h"
#include "scenarios/loader.h"

namespace simbench::python {

class PythonFailure : public scenarios::InputError {
 public:
  PythonFailure(const std::string& text, SharedObject exception)
      : InputError(text), exception_(std::move(exception)) {}
  // The exception that Python raised, with its traceback.
  const SharedObject& exception() const { return exception_; }

 private:
  SharedObject exception_;
};

// The exception within `error` or nested in it (std::nested_exception); null if there is none.
SharedObject python_exception_in(const std::exception& error);

struct PythonAlgorithm {
  AlgorithmInfo info;
  std::string kind;    // "class MeanOfLast"
  std::string method;  // "stamp"
  std::string file;
  int line = 0;                    // of the method
  std::vector<std::string> whole;  // parameters that are whole numbers
  SharedObject make;               // called with the parameters; returns the object
  SharedObject traits;             // what the decorator knows besides
};

// From a decorator's dictionary: name, summary, parameters, needs, kind, method, file, line, make.
PythonAlgorithm algorithm_of(const Object& definition);

// All of these need the GIL.
Object keywords_of(const PythonAlgorithm& algorithm, const Parameters& parameters);
Object make_instance(const PythonAlgorithm& algorithm, const Object& keywords);
SharedObject method_of(const PythonAlgorithm& algorithm, const Object& object, const char* name);
// Whether the class says so: `relative = True`.
bool has_trait(const PythonAlgorithm& algorithm, const char* name);
[[noreturn]] void throw_python_failure(const PythonAlgorithm& algorithm, const PythonError& raised);
// The error that Python has set.
[[noreturn]] void throw_python_failure(const PythonAlgorithm& algorithm);
// What a method returned or did: "returned None; expected ...".
[[noreturn]] void throw_misuse(const PythonAlgorithm& algorithm, const std::string& text);

}  // namespace simbench::python
