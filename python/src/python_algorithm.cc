#include "python/src/python_algorithm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace simbench::python {

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

std::string text_in(const Object& dictionary, const char* key) {
  return dictionary[key].as<std::string>();
}

ParameterSpec spec_of(const Object& parameter) {
  ParameterSpec spec;
  spec.name = text_in(parameter, "name");
  spec.meaning = text_in(parameter, "meaning");
  spec.source = text_in(parameter, "source");
  const Object fallback = parameter["default"];
  if (PyBool_Check(fallback.get())) {
    spec.fallback = fallback.as<bool>();
  } else if (PyUnicode_Check(fallback.get())) {
    spec.fallback = fallback.as<std::string>();
    spec.choices = parameter["choices"].as<std::vector<std::string>>();
  } else {
    spec.fallback = fallback.as<double>();
    spec.low = parameter["low"].as<double>();
    spec.high = parameter["high"].as<double>();
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
  throw_error(
      PyExc_ValueError,
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
int line_of(const PythonAlgorithm& algorithm, const Object& exception) {
  int line = algorithm.line;
  for (Object at = exception.attribute("__traceback__"); !at.is_none();
       at = at.attribute("tb_next")) {
    const Object code = at.attribute("tb_frame").attribute("f_code");
    if (code.attribute("co_filename").as<std::string>() == algorithm.file) {
      line = at.attribute("tb_lineno").as<int>();
    }
  }
  return line;
}

}  // namespace

PythonAlgorithm algorithm_of(const Object& definition) {
  PythonAlgorithm algorithm;
  algorithm.kind = text_in(definition, "kind");
  algorithm.method = text_in(definition, "method");
  algorithm.file = text_in(definition, "file");
  algorithm.line = definition["line"].as<int>();
  algorithm.info.name = text_in(definition, "name");
  algorithm.info.family = algorithm.info.name;
  algorithm.info.summary = text_in(definition, "summary");
  algorithm.info.source = place(algorithm.file, algorithm.line);
  for (const Object& parameter : definition["parameters"].as<std::vector<Object>>()) {
    algorithm.info.parameters.push_back(spec_of(parameter));
    if (parameter["whole"].as<bool>()) {
      algorithm.whole.push_back(algorithm.info.parameters.back().name);
    }
  }
  for (const std::string& need : definition["needs"].as<std::vector<std::string>>()) {
    algorithm.info.needs.push_back(need_of(need));
  }
  algorithm.make = shared(definition["make"]);
  algorithm.traits = shared(definition);
  return algorithm;
}

Object keywords_of(const PythonAlgorithm& algorithm, const Parameters& parameters) {
  Object keywords = dict();
  for (const auto& [name, value] : parameters.all()) {
    const double* const number = std::get_if<double>(&value);
    if (number == nullptr || std::ranges::count(algorithm.whole, name) == 0) {
      const char* const key = name.c_str();
      std::visit([&](const auto& held) { keywords.set(key, held); }, value);
    } else if (*number == std::floor(*number) && std::abs(*number) < 9e15) {
      keywords.set(name.c_str(), static_cast<std::int64_t>(*number));
    } else {
      throw ParameterError(
          name, fmt::format("parameter \"{}\" is {}; allowed: a whole number", name, *number));
    }
  }
  return keywords;
}

Object make_instance(const PythonAlgorithm& algorithm, const Object& keywords) {
  const Object nothing = python_tuple({});
  PyObject* const made = PyObject_Call(algorithm.make.get(), nothing.get(), keywords.get());
  if (made == nullptr) throw_python_failure(algorithm);
  return Object::owned(made);
}

SharedObject method_of(const PythonAlgorithm& algorithm, const Object& object, const char* name) {
  PyObject* const method = PyObject_GetAttrString(object.get(), name);
  if (method == nullptr) throw_python_failure(algorithm);
  return shared(Object::owned(method));
}

bool has_trait(const PythonAlgorithm& algorithm, const char* name) {
  const Object traits = Object::borrowed(algorithm.traits.get());
  return traits.contains(name) && traits[name].as<bool>();
}

void throw_python_failure(const PythonAlgorithm& algorithm, const PythonError& raised) {
  const Object exception = raised.exception();
  throw PythonFailure(
      fmt::format("{}: {}", prefix(algorithm, line_of(algorithm, exception)), raised.what()),
      shared(exception));
}

void throw_python_failure(const PythonAlgorithm& algorithm) {
  throw_python_failure(algorithm, PythonError::raised());
}

void throw_misuse(const PythonAlgorithm& algorithm, const std::string& text) {
  const std::string message = fmt::format("{} {}", prefix(algorithm, algorithm.line), text);
  throw PythonFailure(message, shared(Object::borrowed(PyExc_ValueError)(message)));
}

}  // namespace simbench::python
