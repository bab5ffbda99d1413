#ifndef SIMBENCH_PYTHON_SRC_BINDINGS_H_
#define SIMBENCH_PYTHON_SRC_BINDINGS_H_
#include <pybind11/pybind11.h>
void bind_algorithms(pybind11::module_& module);
#endif  // SIMBENCH_PYTHON_SRC_BINDINGS_H_
