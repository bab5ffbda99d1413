#include "python/src/rows.h"

#include <pybind11/pybind11.h>

#include <cstdint>

#include "python/src/bindings.h"

namespace py = pybind11;

void bind_rows(pybind11::module_& module) {
  using simbench::python::Rows;
  py::class_<Rows>(module, "Rows", py::buffer_protocol())
      .def_buffer([](Rows& rows) {
        // Read-only: the buffer is never written through this pointer.
        return py::buffer_info(static_cast<std::uint8_t*>(const_cast<void*>(rows.data())), 1,
                               py::format_descriptor<std::uint8_t>::format(), 1,
                               {static_cast<py::ssize_t>(rows.bytes())}, {py::ssize_t{1}}, true);
      })
      .def_property_readonly("row_bytes", &Rows::row_bytes)
      .def_property_readonly(
          "address", [](const Rows& rows) { return reinterpret_cast<std::uintptr_t>(rows.data()); })
      .def_property_readonly("fields", [](const Rows& rows) {
        py::list fields;
        for (const auto& field : rows.fields()) {
          fields.append(py::make_tuple(field.name, field.format, field.offset));
        }
        return fields;
      });
}
