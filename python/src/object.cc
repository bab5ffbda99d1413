#include "python/src/object.h"

#include <fmt/format.h>

namespace simbench::python {
namespace {

std::string type_name(PyObject* object) {
  PyObject* const type = reinterpret_cast<PyObject*>(Py_TYPE(object));
  return Object::borrowed(type).attribute("__name__").as<std::string>();
}

// What str() or repr() has given; nothing if that has raised an error.
std::optional<std::string> text_or_nothing(PyObject* text) {
  if (text == nullptr) {
    PyErr_Clear();
    return std::nullopt;
  }
  return Object::owned(text).as<std::string>();
}

std::string exception_text(PyObject* exception) {
  const std::string type = type_name(exception);
  const std::string message = text_or_nothing(PyObject_Str(exception)).value_or("");
  return message.empty() ? type : type + ": " + message;
}

}  // namespace

Object Object::owned(PyObject* object) {
  if (object == nullptr) throw PythonError::raised();
  return Object(object);
}

Object Object::borrowed(PyObject* object) {
  Py_XINCREF(object);
  return Object(object);
}

Object::Object(const Object& other) : object_(other.object_) { Py_XINCREF(object_); }

Object& Object::operator=(Object other) noexcept {
  std::swap(object_, other.object_);
  return *this;
}

Object Object::attribute(const char* name) const {
  return owned(PyObject_GetAttrString(object_, name));
}

Object Object::operator[](const char* key) const {
  return owned(PyMapping_GetItemString(object_, key));
}

bool Object::contains(const char* key) const { return PyMapping_HasKeyString(object_, key) != 0; }

void Object::set_object(const char* key, const Object& value) {
  if (PyDict_SetItemString(object_, key, value.get()) != 0) throw PythonError::raised();
}

Object Object::call(std::initializer_list<Object> values) const {
  return owned(PyObject_Call(object_, python_tuple(values).get(), nullptr));
}

SharedObject shared(Object object) {
  return {object.release(), [](PyObject* held) {
            // After the interpreter there is nothing left to free.
            if (held == nullptr || Py_IsInitialized() == 0) return;
            const WithGil gil;
            Py_DECREF(held);
          }};
}

Object imported(const char* module) { return Object::owned(PyImport_ImportModule(module)); }

PythonError::PythonError(const Object& exception)
    : exception_(shared(exception)), text_(exception_text(exception.get())) {}

PythonError PythonError::raised() {
  PyObject* type = nullptr;
  PyObject* value = nullptr;
  PyObject* traceback = nullptr;
  PyErr_Fetch(&type, &value, &traceback);
  PyErr_NormalizeException(&type, &value, &traceback);
  if (value != nullptr && traceback != nullptr) PyException_SetTraceback(value, traceback);
  Py_XDECREF(type);
  Py_XDECREF(traceback);
  if (value == nullptr) throw std::logic_error("Python has raised no error");
  return PythonError(Object::owned(value));
}

void PythonError::restore() const {
  PyObject* const exception = exception_.get();
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception)), exception);
}

void throw_error(PyObject* type, const std::string& text) {
  throw PythonError(Object::borrowed(type)(text));
}

ConversionError::ConversionError(PyObject* found, const std::string& allowed)
    : runtime_error(fmt::format("found {}, allowed: {}", shown(found), allowed)) {}

std::string shown(PyObject* object) {
  if (object == Py_None) return "None";
  const std::string type = type_name(object);
  const std::optional<std::string> value = text_or_nothing(PyObject_Repr(object));
  if (!value) return type;
  constexpr std::size_t kShort = 40;
  return value->size() > kShort ? "a " + type : fmt::format("{} ({})", *value, type);
}

std::string_view bytes_in(PyObject* object) {
  char* data = nullptr;
  Py_ssize_t size = 0;
  if (PyBytes_AsStringAndSize(object, &data, &size) != 0) throw PythonError::raised();
  return {data, static_cast<std::size_t>(size)};
}

Object python_bytes(const void* data, std::size_t size) {
  return Object::owned(
      PyBytes_FromStringAndSize(static_cast<const char*>(data), static_cast<Py_ssize_t>(size)));
}

Items::Items(PyObject* iterable)
    : sequence_(Object::owned(PySequence_Fast(iterable, "found no sequence"))),
      is_list_(PyList_Check(sequence_.get())) {
  const Py_ssize_t size = is_list_ ? PyList_Size(sequence_.get()) : PyTuple_Size(sequence_.get());
  size_ = static_cast<std::size_t>(size);
}

PyObject* Items::operator[](std::size_t place) const {
  const auto at = static_cast<Py_ssize_t>(place);
  PyObject* const item =
      is_list_ ? PyList_GetItem(sequence_.get(), at) : PyTuple_GetItem(sequence_.get(), at);
  if (item == nullptr) throw PythonError::raised();
  return item;
}

bool Conversion<bool>::from(PyObject* object) {
  if (!PyBool_Check(object) && PyNumber_Check(object) == 0) {
    throw ConversionError(object, "True or False");
  }
  const int is_true = PyObject_IsTrue(object);
  if (is_true < 0) throw PythonError::raised();
  return is_true != 0;
}

std::int64_t signed_number(PyObject* object, std::int64_t low, std::int64_t high) {
  if (PyIndex_Check(object) == 0) throw ConversionError(object, "a whole number");
  const Object index = Object::owned(PyNumber_Index(object));
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(index.get(), &overflow);
  if (overflow == 0 && value >= low && value <= high) return value;
  throw ConversionError(object, fmt::format("a whole number from {} to {}", low, high));
}

std::uint64_t unsigned_number(PyObject* object, std::uint64_t high) {
  if (PyIndex_Check(object) == 0) throw ConversionError(object, "a whole number");
  const Object index = Object::owned(PyNumber_Index(object));
  const unsigned long long value = PyLong_AsUnsignedLongLong(index.get());
  const bool is_outside = PyErr_Occurred() != nullptr;
  if (is_outside) PyErr_Clear();
  if (!is_outside && value <= high) return value;
  throw ConversionError(object, fmt::format("a whole number from 0 to {}", high));
}

double Conversion<double>::from(PyObject* object) {
  const double value = PyFloat_AsDouble(object);
  if (value != -1 || PyErr_Occurred() == nullptr) return value;
  PyErr_Clear();
  throw ConversionError(object, "a number");
}

std::string Conversion<std::string>::from(PyObject* object) {
  if (!PyUnicode_Check(object)) throw ConversionError(object, "a text");
  const Object bytes = Object::owned(PyUnicode_AsEncodedString(object, "utf-8", "surrogateescape"));
  return std::string(bytes_in(bytes.get()));
}

Object Conversion<std::string>::to(std::string_view value) {
  return Object::owned(
      PyUnicode_DecodeUTF8(value.data(), static_cast<Py_ssize_t>(value.size()), "surrogateescape"));
}

std::vector<Object> sequence_of(PyObject* object, std::optional<std::size_t> count) {
  const bool is_text = PyUnicode_Check(object) || PyBytes_Check(object);
  if (is_text || PyDict_Check(object) || PySequence_Check(object) == 0) {
    throw ConversionError(object, "a list");
  }
  const Items items(object);
  if (count && items.size() != *count) {
    throw ConversionError(object, fmt::format("a list of {}", *count));
  }
  std::vector<Object> sequence;
  for (std::size_t i = 0; i < items.size(); ++i) sequence.push_back(Object::borrowed(items[i]));
  return sequence;
}

Object python_list(const std::vector<Object>& items) {
  Object list = Object::owned(PyList_New(static_cast<Py_ssize_t>(items.size())));
  Py_ssize_t place = 0;
  for (Object item : items) PyList_SetItem(list.get(), place++, item.release());
  return list;
}

Object python_tuple(std::initializer_list<Object> items) {
  Object tuple = Object::owned(PyTuple_New(static_cast<Py_ssize_t>(items.size())));
  Py_ssize_t place = 0;
  for (Object item : items) PyTuple_SetItem(tuple.get(), place++, item.release());
  return tuple;
}

Object dict(std::initializer_list<DictItem> items) {
  Object made = Object::owned(PyDict_New());
  for (const DictItem& item : items) made.set(item.key, item.value);
  return made;
}

}  // namespace simbench::python
