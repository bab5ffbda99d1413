// The small objects that algorithms in Python get for each frame: simbench.Sample, simbench.Frame.
//
// They are plain structs behind read-only attributes, as a frame may not cost more than a method's
// call. An object that the algorithm has not kept is used again for the next frame.
//
//   RecordReference reference;
//   SampleRecord& record = renewed<SampleRecord>(reference);   // with the GIL
//   record.sensor_ns = 5;
//   PyObject_CallOneArg(method, reference.get());
#pragma once

#include <new>

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

// Owns a record of one kind; may be dropped on any thread.
class RecordReference {
 public:
  RecordReference() = default;
  RecordReference(const RecordReference&) = delete;
  RecordReference& operator=(const RecordReference&) = delete;
  ~RecordReference() {
    if (object_ != nullptr) shared(Object::owned(object_));
  }

  PyObject* get() const { return object_; }
  // With the GIL.
  void set(PyObject* object) {
    Py_XDECREF(object_);
    object_ = object;
  }

 private:
  PyObject* object_ = nullptr;
};

// The record itself if nobody else has it, else a new one. With the GIL.
template <class Record>
Record& renewed(RecordReference& reference) {
  PyObject* object = reference.get();
  if (object == nullptr || Py_REFCNT(object) > 1) {
    object = PyType_GenericAlloc(Record::type, 0);
    if (object == nullptr) throw std::bad_alloc();
    reference.set(object);
  }
  return *reinterpret_cast<Record*>(object);
}

}  // namespace simbench::python
