// Objects of Python: owned references, conversions, errors, and the interpreter's lock.
//
// All of python/src stands on this header and on binding.h, and these on the limited C API of
// CPython 3.9 alone, so that one module (_simbench.abi3.so) serves every later version. Python.h is
// included here and nowhere else. The API's contents:
// https://docs.python.org/3/c-api/stable.html
//
// An Object and all functions below need the interpreter's lock (GIL), a SharedObject and a
// PythonError may be copied and dropped without it.
//
// Errors: what Python raises is a PythonError; an object that is not what was asked for is a
// ConversionError, "found 5 (int), allowed: a text".
//
//   const WithGil gil;
//   const Object parameter = imported("simbench.algorithms").attribute("Parameter")(30, 1, 1000);
//   const auto low = parameter.attribute("low").as<double>();
#pragma once

#define Py_LIMITED_API 0x03090000
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simbench::python {

// Holds the lock; a thread that has it may take it again.
class WithGil {
 public:
  WithGil() : state_(PyGILState_Ensure()) {}
  ~WithGil() { PyGILState_Release(state_); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  PyGILState_STATE state_;
};

// Lets other threads have it.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() { PyEval_RestoreThread(state_); }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

// An object that may be dropped on any thread, with or without the lock, and after the interpreter.
using SharedObject = std::shared_ptr<PyObject>;

// An owned reference, or none.
class Object {
 public:
  Object() = default;
  // Takes over what a function of Python returned; throws its error if that is null.
  static Object owned(PyObject* object);
  static Object borrowed(PyObject* object);
  static Object none() { return borrowed(Py_None); }
  Object(const Object& other);
  Object(Object&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Object& operator=(Object other) noexcept;
  ~Object() { Py_XDECREF(object_); }

  PyObject* get() const { return object_; }
  PyObject* release() { return std::exchange(object_, nullptr); }
  bool is_none() const { return object_ == Py_None; }

  Object attribute(const char* name) const;
  // The item of a dictionary.
  Object operator[](const char* key) const;
  bool contains(const char* key) const;
  template <class Value>
  void set(const char* key, const Value& value);
  template <class... Values>
  Object operator()(const Values&... values) const;
  // Throws ConversionError.
  template <class Value>
  Value as() const;

 private:
  explicit Object(PyObject* object) : object_(object) {}
  void set_object(const char* key, const Object& value);
  Object call(std::initializer_list<Object> values) const;

  PyObject* object_ = nullptr;
};

SharedObject shared(Object object);
Object imported(const char* module);

// What Python raised.
class PythonError : public std::exception {
 public:
  explicit PythonError(const Object& exception);
  // Takes over the error that Python has set.
  static PythonError raised();
  // With its traceback.
  Object exception() const { return Object::borrowed(exception_.get()); }
  // Sets it again, for the caller in Python.
  void restore() const;
  // "ZeroDivisionError: division by zero"
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  SharedObject exception_;
  std::string text_;
};

// Raises it in C++: throw_error(PyExc_ValueError, "found ..., allowed: ...").
[[noreturn]] void throw_error(PyObject* type, const std::string& text);

class ConversionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ConversionError(PyObject* found, const std::string& allowed);
};

// "5 (int)", "None"; "a list" where its text is long.
std::string shown(PyObject* object);

// The bytes of an object of `bytes`, until it is dropped.
std::string_view bytes_in(PyObject* object);
Object python_bytes(const void* data, std::size_t size);

// The items of a list or of something else that can be iterated over, which it owns.
class Items {
 public:
  // Throws PythonError.
  explicit Items(PyObject* iterable);
  std::size_t size() const { return size_; }
  PyObject* operator[](std::size_t place) const;

 private:
  Object sequence_;
  std::size_t size_ = 0;
  bool is_list_ = false;
};

// How a type is read and written: from(object) throws ConversionError, to(value) gives an object.
template <class Value>
struct Conversion;

template <class Value>
concept Converted = requires {
  sizeof(Conversion<Value>);
};

template <>
struct Conversion<Object> {
  static Object from(PyObject* object) { return Object::borrowed(object); }
  static Object to(const Object& value) { return value; }
};

template <>
struct Conversion<bool> {
  static bool from(PyObject* object);
  static Object to(bool value) { return Object::borrowed(value ? Py_True : Py_False); }
};

std::int64_t signed_number(PyObject* object, std::int64_t low, std::int64_t high);
std::uint64_t unsigned_number(PyObject* object, std::uint64_t high);

template <std::integral Value>
struct Conversion<Value> {
  static Value from(PyObject* object) {
    using Limits = std::numeric_limits<Value>;
    if constexpr (std::signed_integral<Value>) {
      return static_cast<Value>(signed_number(object, Limits::min(), Limits::max()));
    } else {
      return static_cast<Value>(unsigned_number(object, Limits::max()));
    }
  }
  static Object to(Value value) {
    if constexpr (std::signed_integral<Value>) return Object::owned(PyLong_FromLongLong(value));
    return Object::owned(PyLong_FromUnsignedLongLong(static_cast<std::uint64_t>(value)));
  }
};

template <>
struct Conversion<double> {
  static double from(PyObject* object);
  static Object to(double value) { return Object::owned(PyFloat_FromDouble(value)); }
};

// As UTF-8; bytes that are none, as names of files may have, come back as they were
// (surrogateescape).
template <>
struct Conversion<std::string> {
  static std::string from(PyObject* object);
  static Object to(std::string_view value);
};

template <class Value>
struct Conversion<std::optional<Value>> {
  static std::optional<Value> from(PyObject* object) {
    if (object == Py_None) return std::nullopt;
    return Conversion<Value>::from(object);
  }
  static Object to(const std::optional<Value>& value) {
    return value ? Conversion<Value>::to(*value) : Object::none();
  }
};

// The items of a list, a tuple or the like, but not of a text. `count`: how many there must be.
std::vector<Object> sequence_of(PyObject* object, std::optional<std::size_t> count = {});
Object python_list(const std::vector<Object>& items);
Object python_tuple(std::initializer_list<Object> items);

template <class Value>
struct Conversion<std::vector<Value>> {
  static std::vector<Value> from(PyObject* object) {
    std::vector<Value> values;
    for (const Object& item : sequence_of(object)) values.push_back(item.as<Value>());
    return values;
  }
  static Object to(const std::vector<Value>& values) {
    std::vector<Object> items;
    for (const Value& value : values) items.push_back(Conversion<Value>::to(value));
    return python_list(items);
  }
};

template <class Value, std::size_t size>
struct Conversion<std::array<Value, size>> {
  static std::array<Value, size> from(PyObject* object) {
    const std::vector<Object> items = sequence_of(object, size);
    std::array<Value, size> values;
    for (std::size_t i = 0; i < size; ++i) values[i] = items[i].template as<Value>();
    return values;
  }
};

template <class First, class Second>
struct Conversion<std::pair<First, Second>> {
  static std::pair<First, Second> from(PyObject* object) {
    const std::vector<Object> items = sequence_of(object, 2);
    return {items[0].as<First>(), items[1].as<Second>()};
  }
  static Object to(const std::pair<First, Second>& value) {
    return python_tuple({Conversion<First>::to(value.first), Conversion<Second>::to(value.second)});
  }
};

template <class Value>
Object to_python(const Value& value) {
  if constexpr (std::is_convertible_v<Value, std::string_view>) {
    return Conversion<std::string>::to(value);
  } else {
    return Conversion<Value>::to(value);
  }
}

// dict({{"name", pipeline.name}, {"seeds", 8}})
struct DictItem {
  template <class Value>
  DictItem(const char* of, const Value& held) : key(of), value(to_python(held)) {}
  const char* key;
  Object value;
};
Object dict(std::initializer_list<DictItem> items = {});

template <class Value>
void Object::set(const char* key, const Value& value) {
  set_object(key, to_python(value));
}

template <class... Values>
Object Object::operator()(const Values&... values) const {
  return call({to_python(values)...});
}

template <class Value>
Value Object::as() const {
  return Conversion<Value>::from(object_);
}

}  // namespace simbench::python
