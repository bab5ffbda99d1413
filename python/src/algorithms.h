// Registration of algorithms in Python, for the decorators of simbench/algorithms.py. Each takes
// the dictionary of python_algorithm.h and needs the GIL. Throws std::invalid_argument for the name
// of one of simbench's own.
//
//   register_python_device_time(definition);
#pragma once

#include <pybind11/pybind11.h>

namespace simbench::python {

void register_python_device_time(const pybind11::dict& definition);
void register_python_gathering(const pybind11::dict& definition);
void register_python_host_sync(const pybind11::dict& definition);
void register_python_capture_alignment(const pybind11::dict& definition);

}  // namespace simbench::python
