// What the Python module `_simbench` is made of: each file of python/src adds its part.
//
// The public interface is written in Python (python/simbench); these functions and classes are what
// it stands on. They convert and call what the commands call, and compute nothing themselves.
#pragma once

#include "python/src/object.h"

namespace simbench::python {

void bind_algorithms(const Object& module);
void bind_clocks(const Object& module);
void bind_command(const Object& module);
void bind_recordings(const Object& module);
void bind_results(const Object& module);
void bind_rows(const Object& module);
void bind_scenarios(const Object& module);

}  // namespace simbench::python
