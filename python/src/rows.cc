#include "python/src/rows.h"

#include <cstdint>

#include "python/src/binding.h"
#include "python/src/bindings.h"

namespace simbench::python {
namespace {

std::uintptr_t address_of(const Rows& rows) {
  return reinterpret_cast<std::uintptr_t>(rows.data());
}

// NumPy's array interface: bytes that may only be read.
Object interface_of(const Rows& rows) {
  return dict({{"version", 3},
               {"typestr", "|u1"},
               {"shape", python_tuple({to_python(rows.bytes())})},
               {"data", python_tuple({to_python(address_of(rows)), to_python(true)})}});
}

std::vector<Object> fields_of(const Rows& rows) {
  std::vector<Object> fields;
  for (const RowField& field : rows.fields()) {
    fields.push_back(
        python_tuple({to_python(field.name), to_python(field.format), to_python(field.offset)}));
  }
  return fields;
}

}  // namespace

void bind_rows(const Object& module) {
  add_class<Rows>(
      module, "simbench._simbench.Rows",
      {.properties = {property("row_bytes", [](const Rows& rows) { return rows.row_bytes(); }),
                      property("address", callable<&address_of>),
                      property("__array_interface__", callable<&interface_of>),
                      property("fields", callable<&fields_of>)}});
}

}  // namespace simbench::python
