// The small objects that algorithms in Python get for each frame: simbench.Sample, simbench.Frame.
//
// They are plain structs behind read-only attributes, as a frame may not cost more than a method's
// call. An object that the algorithm has not kept is used again for the next frame, and so are the
// arguments of the call.
//
//   RecordMethod<SampleRecord> stamp(method);   // with the GIL
//   stamp.renewed().sensor_ns = 5;
//   PyObject* const result = stamp.called();
#pragma once

#include <utility>

#include "python/src/python_algorithm.h"

namespace simbench::python {

struct SampleRecord {
  static PyTypeObject* type;

  PyObject_HEAD long long sensor_ns;
  long long arrival_ns;
  long long arrival_steady_ns;
  unsigned int exposure_us;
};

struct FrameRecordObject {
  static PyTypeObject* type;

  PyObject_HEAD unsigned int source;
  long long stamp_ns;
  long long arrival_ns;
  long long sensor_ns;
  // Not for Python.
  long long tag;
  bool is_used;  // it has been in a set
};

// Adds both types to the module, before anything is renewed.
void bind_records(const Object& module);

// How a method is called with a record: by its function and a tuple of arguments, the method's
// object first and the record last. (A bound method would put them together anew for each call.)
struct RecordFunction {
  SharedObject function;
  Object arguments;      // with None where the record comes
  Py_ssize_t place = 0;  // of the record
};
RecordFunction record_function(const SharedObject& method);

// Calls a method with one record after another. May be dropped on any thread; the rest is with the
// GIL.
template <class Record>
class RecordMethod {
 public:
  RecordMethod() = default;
  explicit RecordMethod(const SharedObject& method) {
    RecordFunction made = record_function(method);
    function_ = std::move(made.function);
    arguments_ = shared(std::move(made.arguments));
    place_ = made.place;
  }

  // The last record if nobody else has it, else a new one. (An interpreter that keeps more in the
  // word of the count makes it larger, never smaller: then each record is new.)
  Record& renewed() {
    if (record_ == nullptr || Py_REFCNT(record_) > 1) {
      record_ = nullptr;
      PyObject* const made = Object::owned(PyType_GenericAlloc(Record::type, 0)).release();
      if (PyTuple_SetItem(arguments_.get(), place_, made) != 0) throw PythonError::raised();
      record_ = made;
    }
    return *reinterpret_cast<Record*>(record_);
  }

  // What it returns, for the caller to own; null: it has raised an error.
  PyObject* called() const { return PyObject_Call(function_.get(), arguments_.get(), nullptr); }

 private:
  SharedObject function_;
  SharedObject arguments_;
  Py_ssize_t place_ = 0;
  PyObject* record_ = nullptr;  // which the arguments own
};

}  // namespace simbench::python
