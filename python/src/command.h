// Command lines within Python: what the package does by the command of the same name.
//
// `_simbench.run_command()` runs a command line in this process (cli/embedding.h) as other long
// work is run (python/src/work.h): on a thread of its own, without the interpreter's lock, with
// progress, until Ctrl-C. Commands run one after the other; one that waits for its turn holds no
// lock of the interpreter. What the command refuses is raised (python/src/errors.cc).
#pragma once

#include <pybind11/pybind11.h>

void bind_command(pybind11::module_& module);
