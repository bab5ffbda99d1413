// Functions and classes of C++ as those of a module of Python.
//
// A function's parameters and result are converted (object.h), or are classes that the module has,
// by reference or as std::shared_ptr. An object of such a class shares a C++ object, so that it may
// be used after the module's caller has dropped it. Arguments have places and no names:
// python/simbench is the public interface.
//
// Errors: what a function throws becomes an exception of Python (errors.cc). A wrong argument is a
// TypeError, "save(): argument 1: found 5 (int), allowed: a text".
//
//   add_functions(module, {function("load_archive", callable<&load_archive>)});
//   add_class<Run>(module, "simbench._simbench.Run",
//                  {.properties = {property("notes", [](const Run& run) { return run.notes; })},
//                   .methods = {method("csv", callable<&csv_of>)}});
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "python/src/object.h"

namespace simbench::python {

// Sets the exception of Python that stands for one of C++.
void set_python_error(const std::exception_ptr& thrown);

// Adds a class under the last part of its name; owned by the module.
PyTypeObject* add_type(const Object& module, PyType_Spec& spec);
// Methods are kept.
void add_functions(const Object& module, std::vector<PyMethodDef> functions);
// Makes no object, for a class whose objects functions return.
PyObject* refuse_new(PyTypeObject* type, PyObject* arguments, PyObject* keywords);
// Gives back the memory of an object, and its hold of its class.
void free_object(PyObject* object);
// Throw ConversionError unless there are so many, and no keywords.
void check_count(const char* function, PyObject* arguments, std::size_t count);
void check_no_keywords(const char* function, PyObject* keywords);

// What Python sees of a C++ object.
template <class Value>
struct Instance {
  static inline PyTypeObject* type = nullptr;
  static inline std::vector<PyGetSetDef> properties{};
  static inline std::vector<PyMethodDef> methods{};

  PyObject_HEAD std::shared_ptr<Value> value;
};

template <class Value>
Object made_instance(std::shared_ptr<Value> value) {
  Object made = Object::owned(PyType_GenericAlloc(Instance<Value>::type, 0));
  new (&reinterpret_cast<Instance<Value>*>(made.get())->value)
      std::shared_ptr<Value>(std::move(value));
  return made;
}

template <class Value>
const std::shared_ptr<Value>& value_of(PyObject* object) {
  if (Py_TYPE(object) == Instance<Value>::type) {
    return reinterpret_cast<Instance<Value>*>(object)->value;
  }
  const auto type = Object::borrowed(reinterpret_cast<PyObject*>(Instance<Value>::type));
  throw ConversionError(object, "a " + type.attribute("__name__").as<std::string>());
}

template <class Value>
struct Conversion<std::shared_ptr<Value>> {
  static std::shared_ptr<Value> from(PyObject* object) { return value_of<Value>(object); }
  static Object to(const std::shared_ptr<Value>& value) { return made_instance(value); }
};

// The parameters and the result of what can be called.
template <class Call>
struct Signature : Signature<decltype(&Call::operator())> {};
template <class Result, class... Parameters>
struct Signature<Result (*)(Parameters...)> {
  using Values = std::tuple<Parameters...>;
  static constexpr std::size_t kCount = sizeof...(Parameters);
};
template <class Class, class Result, class... Parameters>
struct Signature<Result (Class::*)(Parameters...) const> : Signature<Result (*)(Parameters...)> {};

// A function as a type of its own.
template <auto pointer>
struct FunctionOf {
  template <class... Values>
  decltype(auto) operator()(Values&&... values) const {
    return pointer(std::forward<Values>(values)...);
  }
};
template <auto pointer>
struct Signature<FunctionOf<pointer>> : Signature<decltype(pointer)> {};

// A value where it is converted, else a reference to what Python holds.
template <class Parameter>
decltype(auto) argument(PyObject* object) {
  using Value = std::remove_cvref_t<Parameter>;
  if constexpr (Converted<Value>) {
    return Conversion<Value>::from(object);
  } else {
    return (*value_of<Value>(object));
  }
}

// `place`: from 1; 0: a value of its own.
template <class Parameter>
decltype(auto) argument_at(const char* name, std::size_t place, PyObject* object) try {
  return argument<Parameter>(object);
} catch (const ConversionError& error) {
  const std::string where = place == 0 ? "" : "(): argument " + std::to_string(place);
  throw ConversionError(name + where + ": " + error.what());
}

// What Python calls: a function, a method (with the object before its arguments), a property.
template <class Call>
class Trampoline {
  static_assert(std::is_empty_v<Call>);

 public:
  static inline const char* name = "";

  static PyObject* function(PyObject* /*module*/, PyObject* arguments) {
    return with_errors([&] {
      check_count(name, arguments, kCount);
      return called(nullptr, arguments, std::make_index_sequence<kCount>());
    });
  }
  static PyObject* method(PyObject* self, PyObject* arguments) {
    return with_errors([&] {
      check_count(name, arguments, kCount - 1);
      return called(self, arguments, std::make_index_sequence<kCount>());
    });
  }
  static PyObject* make(PyTypeObject* /*type*/, PyObject* arguments, PyObject* keywords) {
    return with_errors([&] {
      check_no_keywords(name, keywords);
      return Object::owned(function(nullptr, arguments));
    });
  }
  static PyObject* property(PyObject* self, void* /*closure*/) {
    return with_errors([&] { return result(argument<At<0>>(self)); });
  }

 private:
  static constexpr std::size_t kCount = Signature<Call>::kCount;
  template <std::size_t place>
  using At = std::tuple_element_t<place, typename Signature<Call>::Values>;

  template <class Work>
  static PyObject* with_errors(const Work& work) {
    try {
      return work().release();
    } catch (...) {
      set_python_error(std::current_exception());
      return nullptr;
    }
  }
  // `self`: the first value; null: there is none but the arguments.
  static PyObject* object_at(PyObject* self, PyObject* arguments, std::size_t place) {
    if (self == nullptr) return PyTuple_GetItem(arguments, static_cast<Py_ssize_t>(place));
    return place == 0 ? self : PyTuple_GetItem(arguments, static_cast<Py_ssize_t>(place - 1));
  }
  template <std::size_t... places>
  static Object called([[maybe_unused]] PyObject* self, [[maybe_unused]] PyObject* arguments,
                       std::index_sequence<places...>) {
    return result(argument_at<At<places>>(name, places + (self == nullptr ? 1 : 0),
                                          object_at(self, arguments, places))...);
  }
  template <class... Values>
  static Object result(Values&&... values) {
    using Result = std::remove_cvref_t<decltype(Call{}(std::forward<Values>(values)...))>;
    if constexpr (std::is_void_v<Result>) {
      Call{}(std::forward<Values>(values)...);
      return Object::none();
    } else if constexpr (Converted<Result>) {
      return Conversion<Result>::to(Call{}(std::forward<Values>(values)...));
    } else {
      return made_instance(std::make_shared<Result>(Call{}(std::forward<Values>(values)...)));
    }
  }
};

// `call` of the following is a lambda without captures, or callable<&function>.
template <auto pointer>
inline constexpr FunctionOf<pointer> callable{};

template <class Call>
PyMethodDef function(const char* name, Call /*call*/) {
  Trampoline<Call>::name = name;
  return {name, &Trampoline<Call>::function, METH_VARARGS, nullptr};
}
// The first parameter is the object, also of a property.
template <class Call>
PyMethodDef method(const char* name, Call /*call*/) {
  Trampoline<Call>::name = name;
  return {name, &Trampoline<Call>::method, METH_VARARGS, nullptr};
}
template <class Call>
PyGetSetDef property(const char* name, Call /*call*/) {
  return {name, &Trampoline<Call>::property, nullptr, nullptr, nullptr};
}

// A data member, which Python may write: field<&RunRequest::seeds>("seeds").
template <auto member>
struct Field;
template <class Class, class Value, Value Class::*member>
struct Field<member> {
  static inline const char* name = "";
  static PyObject* get(PyObject* self, void* /*closure*/) {
    return to_python((*value_of<Class>(self)).*member).release();
  }
  static int set(PyObject* self, PyObject* value, void* /*closure*/) {
    try {
      if (value == nullptr) throw_error(PyExc_TypeError, std::string(name) + ": cannot be deleted");
      (*value_of<Class>(self)).*member = argument_at<Value>(name, 0, value);
      return 0;
    } catch (...) {
      set_python_error(std::current_exception());
      return -1;
    }
  }
};
template <auto member>
PyGetSetDef field(const char* name) {
  Field<member>::name = name;
  return {name, &Field<member>::get, &Field<member>::set, nullptr, nullptr};
}

struct ClassParts {
  std::vector<PyGetSetDef> properties{};
  std::vector<PyMethodDef> methods{};
  newfunc make = &refuse_new;
};

// For classes whose objects Python makes: maker("Options", [] { return Options{}; }).
template <class Call>
newfunc maker(const char* name, Call /*call*/) {
  Trampoline<Call>::name = name;
  return &Trampoline<Call>::make;
}

template <class Value>
void add_class(const Object& module, const char* name, ClassParts parts) {
  using Made = Instance<Value>;
  Made::properties = std::move(parts.properties);
  Made::properties.push_back({});
  Made::methods = std::move(parts.methods);
  Made::methods.push_back({});
  const auto drop = [](PyObject* object) {
    std::destroy_at(&reinterpret_cast<Made*>(object)->value);
    free_object(object);
  };
  PyType_Slot slots[] = {{Py_tp_new, reinterpret_cast<void*>(parts.make)},
                         {Py_tp_dealloc, reinterpret_cast<void*>(+drop)},
                         {Py_tp_getset, Made::properties.data()},
                         {Py_tp_methods, Made::methods.data()},
                         {0, nullptr}};
  PyType_Spec spec = {name, sizeof(Made), 0, Py_TPFLAGS_DEFAULT, slots};
  Made::type = add_type(module, spec);
}

}  // namespace simbench::python
