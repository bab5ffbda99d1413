#include "python/src/bindings.h"

namespace simbench::python {

void bind_results(pybind11::module_& module) { static_cast<void>(module); }

}  // namespace simbench::python
