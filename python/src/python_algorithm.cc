#include "python/src/python_algorithm.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace simbench::python {

SharedObject shared(py::object object) {
  return {object.release().ptr(), [](PyObject* held) {
            // After the interpreter there is nothing left to free.
            if (held == nullptr || Py_IsInitialized() == 0) return;
            const py::gil_scoped_acquire gil;
            Py_DECREF(held);
          }};
}

SharedObject python_exception_in(const std::exception& error) {
  if (const auto* failure = dynamic_cast<const PythonFailure*>(&error)) {
    return failure->exception();
  }
  try {
    std::rethrow_if_nested(error);
  } catch (const std::exception& inner) {
    return python_exception_in(inner);
  } catch (...) {
    return nullptr;
  }
  return nullptr;
}

namespace {

ParameterSpec spec_of(const py::handle& parameter) {
  const auto text = [&](const char* key) { return parameter[key].cast<std::string>(); };
  ParameterSpec spec;
  spec.name = text("name");
  spec.meaning = text("meaning");
  spec.source = text("source");
  const py::object fallback = parameter["default"];
  if (py::isinstance<py::bool_>(fallback)) {
    spec.fallback = fallback.cast<bool>();
  } else if (py::isinstance<py::str>(fallback)) {
    spec.fallback = fallback.cast<std::string>();
    spec.choices = parameter["choices"].cast<std::vector<std::string>>();
  } else {
    spec.fallback = fallback.cast<double>();
    spec.low = parameter["low"].cast<double>();
    spec.high = parameter["high"].cast<double>();
  }
  return spec;
}

Need need_of(const std::string& name) {
  static const std::map<std::string, Need> needs = {{"hardware_stamps", Need::kHardwareStamps},
                                                    {"pps", Need::kPps},
                                                    {"gnss", Need::kGnss},
                                                    {"trigger_line", Need::kTriggerLine},
                                                    {"tsf", Need::kTsf},
                                                    {"ftm", Need::kFtm},
                                                    {"frames", Need::kFrames},
                                                    {"frame_control", Need::kFrameControl},
                                                    {"polls", Need::kPolls},
                                                    {"host_stamps", Need::kHostStamps}};
  const auto found = needs.find(name);
  if (found != needs.end()) return found->second;
  throw py::value_error(
      fmt::format("needs: found '{}', allowed: hardware_stamps, pps, gnss, trigger_line, tsf, ftm, "
                  "frames, frame_control, polls, host_stamps",
                  name));
}

// "file.py:12", without the folder.
std::string place(const std::string& file, int line) {
  return fmt::format("{}:{}", file.substr(file.rfind('/') + 1), line);
}

std::string prefix(const PythonAlgorithm& algorithm, int line) {
  return fmt::format("{}.{} ({})", algorithm.kind, algorithm.method, place(algorithm.file, line));
}

// The last line of the traceback that is in the algorithm's file; else that of its method.
int line_of(const PythonAlgorithm& algorithm, const py::handle& traceback) {
  int line = algorithm.line;
  for (py::object at = py::reinterpret_borrow<py::object>(traceback); at && !at.is_none();
       at = at.attr("tb_next")) {
    const py::object code = at.attr("tb_frame").attr("f_code");
    if (code.attr("co_filename").cast<std::string>() == algorithm.file) {
      line = at.attr("tb_lineno").cast<int>();
    }
  }
  return line;
}

// "ZeroDivisionError: division by zero"
std::string exception_text(const py::handle& exception) {
  const std::string type = py::str(py::type::handle_of(exception).attr("__name__"));
  PyObject* const text = PyObject_Str(exception.ptr());
  if (text == nullptr) {
    PyErr_Clear();
    return type;
  }
  const std::string message = py::reinterpret_steal<py::str>(text);
  return message.empty() ? type : type + ": " + message;
}

}  // namespace

PythonAlgorithm algorithm_of(const py::dict& definition) {
  const auto text = [&](const char* key) { return definition[key].cast<std::string>(); };
  PythonAlgorithm algorithm;
  algorithm.kind = text("kind");
  algorithm.method = text("method");
  algorithm.file = text("file");
  algorithm.line = definition["line"].cast<int>();
  algorithm.info.name = text("name");
  algorithm.info.family = algorithm.info.name;
  algorithm.info.summary = text("summary");
  algorithm.info.source = place(algorithm.file, algorithm.line);
  for (const py::handle parameter : definition["parameters"]) {
    algorithm.info.parameters.push_back(spec_of(parameter));
    if (parameter["whole"].cast<bool>()) {
      algorithm.whole.push_back(algorithm.info.parameters.back().name);
    }
  }
  for (const py::handle need : definition["needs"]) {
    algorithm.info.needs.push_back(need_of(need.cast<std::string>()));
  }
  algorithm.make = shared(definition["make"]);
  algorithm.traits = shared(definition);
  return algorithm;
}

py::dict keywords_of(const PythonAlgorithm& algorithm, const Parameters& parameters) {
  py::dict keywords;
  for (const auto& [name, value] : parameters.all()) {
    const py::str key(name);
    if (const bool* flag = std::get_if<bool>(&value)) {
      keywords[key] = py::bool_(*flag);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      keywords[key] = py::str(*text);
    } else {
      const double number = std::get<double>(value);
      if (std::ranges::count(algorithm.whole, name) == 0) {
        keywords[key] = py::float_(number);
      } else if (number == std::floor(number) && std::abs(number) < 9e15) {
        keywords[key] = py::int_(static_cast<std::int64_t>(number));
      } else {
        throw ParameterError(
            name, fmt::format("parameter \"{}\" is {}; allowed: a whole number", name, number));
      }
    }
  }
  return keywords;
}

py::object make_instance(const PythonAlgorithm& algorithm, const Parameters& parameters) {
  const py::dict keywords = keywords_of(algorithm, parameters);
  PyObject* const made = PyObject_Call(algorithm.make.get(), py::tuple(0).ptr(), keywords.ptr());
  if (made == nullptr) throw_python_failure(algorithm);
  return py::reinterpret_steal<py::object>(made);
}

SharedObject method_of(const PythonAlgorithm& algorithm, const py::object& object,
                       const char* name) {
  PyObject* const method = PyObject_GetAttrString(object.ptr(), name);
  if (method == nullptr) throw_python_failure(algorithm);
  return shared(py::reinterpret_steal<py::object>(method));
}

bool has_trait(const PythonAlgorithm& algorithm, const char* name) {
  const py::handle traits(algorithm.traits.get());
  return traits.contains(name) && traits[name].cast<bool>();
}

void throw_python_failure(const PythonAlgorithm& algorithm) {
  py::error_already_set raised;  // takes the error over
  const py::object exception = raised.value();
  if (raised.trace()) PyException_SetTraceback(exception.ptr(), raised.trace().ptr());
  throw PythonFailure(fmt::format("{}: {}", prefix(algorithm, line_of(algorithm, raised.trace())),
                                  exception_text(exception)),
                      shared(exception));
}

void throw_misuse(const PythonAlgorithm& algorithm, const std::string& text) {
  const std::string message = fmt::format("{} {}", prefix(algorithm, algorithm.line), text);
  const py::object type = py::reinterpret_borrow<py::object>(PyExc_ValueError);
  throw PythonFailure(message, shared(type(message)));
}

std::string shown(PyObject* object) {
  if (object == Py_None) return "None";
  const std::string type = py::str(py::type::handle_of(object).attr("__name__"));
  PyObject* const text = PyObject_Repr(object);
  if (text == nullptr) {
    PyErr_Clear();
    return type;
  }
  const std::string value = py::reinterpret_steal<py::str>(text);
  constexpr std::size_t kShort = 40;
  return value.size() > kShort ? "a " + type : fmt::format("{} ({})", value, type);
}

}  // namespace simbench::python
