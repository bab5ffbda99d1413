// What the Python module `_simbench` is made of: each file of python/src adds its part.
//
// The public interface is written in Python (python/simbench); these functions and classes are what
// it stands on. They convert and call what the commands call, and compute nothing themselves.
#pragma once

#include <pybind11/pybind11.h>

void bind_algorithms(pybind11::module_& module);
void bind_clocks(pybind11::module_& module);
void bind_errors(pybind11::module_& module);
void bind_recordings(pybind11::module_& module);
void bind_results(pybind11::module_& module);
void bind_rows(pybind11::module_& module);
void bind_scenarios(pybind11::module_& module);
