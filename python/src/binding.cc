#include "python/src/binding.h"

#include <cstring>

namespace simbench::python {

PyTypeObject* add_type(const Object& module, PyType_Spec& spec) {
  Object type = Object::owned(PyType_FromSpec(&spec));
  PyObject* const held = type.get();
  // Takes the reference over.
  if (PyModule_AddObject(module.get(), std::strrchr(spec.name, '.') + 1, held) != 0) {
    throw PythonError::raised();
  }
  type.release();
  return reinterpret_cast<PyTypeObject*>(held);
}

void add_functions(const Object& module, std::vector<PyMethodDef> functions) {
  static std::vector<std::vector<PyMethodDef>> kept;
  functions.push_back({});
  kept.push_back(std::move(functions));
  if (PyModule_AddFunctions(module.get(), kept.back().data()) != 0) throw PythonError::raised();
}

PyObject* refuse_new(PyTypeObject* /*type*/, PyObject* /*arguments*/, PyObject* /*keywords*/) {
  PyErr_SetString(PyExc_TypeError, "the functions of simbench make these objects");
  return nullptr;
}

void free_object(PyObject* object) {
  PyTypeObject* const type = Py_TYPE(object);
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(object);
  Py_DECREF(type);
}

void check_no_keywords(const char* function, PyObject* keywords) {
  if (keywords == nullptr || PyDict_Size(keywords) == 0) return;
  throw ConversionError(std::string(function) + "(): found keywords, allowed: none");
}

void check_count(const char* function, PyObject* arguments, std::size_t count) {
  const auto found = static_cast<std::size_t>(PyTuple_Size(arguments));
  if (found == count) return;
  throw ConversionError(std::string(function) + "(): found " + std::to_string(found) +
                        " arguments, allowed: " + std::to_string(count));
}

}  // namespace simbench::python
