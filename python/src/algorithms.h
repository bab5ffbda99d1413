// Registration of algorithms in Python, for the decorators of simbench/algorithms.py. Each takes
// the dictionary of python_algorithm.h and needs the GIL. Throws std::invalid_argument for the name
// of one of simbench's own.
//
//   register_python_device_time(definition);
#pragma once

#include "python/src/object.h"

namespace simbench::python {

void register_python_device_time(const Object& definition);
void register_python_gathering(const Object& definition);
void register_python_host_sync(const Object& definition);
void register_python_capture_alignment(const Object& definition);

}  // namespace simbench::python
