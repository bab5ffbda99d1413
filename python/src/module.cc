#include <pybind11/pybind11.h>

#include "python/src/bindings.h"

PYBIND11_MODULE(_simbench, module) {
  bind_algorithms(module);
}
