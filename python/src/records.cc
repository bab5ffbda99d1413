#include "python/src/records.h"

#include <structmember.h>

#include <array>
#include <cstddef>

#include "python/src/binding.h"

namespace simbench::python {

PyTypeObject* SampleRecord::type = nullptr;
PyTypeObject* FrameRecordObject::type = nullptr;

namespace {

constexpr PyMemberDef whole(const char* name, std::size_t at, const char* text) {
  return {name, T_LONGLONG, static_cast<Py_ssize_t>(at), READONLY, text};
}
constexpr PyMemberDef small(const char* name, std::size_t at, const char* text) {
  return {name, T_UINT, static_cast<Py_ssize_t>(at), READONLY, text};
}

std::array<PyMemberDef, 5> sample_members = {
    whole("sensor_ns", offsetof(SampleRecord, sensor_ns),
          "middle of the exposure on the camera's clock, unwrapped, a multiple of 1000"),
    whole("arrival_ns", offsetof(SampleRecord, arrival_ns), "delivery on the host's system clock"),
    whole("arrival_steady_ns", offsetof(SampleRecord, arrival_steady_ns),
          "the same instant on the host's steady clock"),
    small("exposure_us", offsetof(SampleRecord, exposure_us), "length of the exposure"),
    PyMemberDef{}};

std::array<PyMemberDef, 5> frame_members = {
    small("source", offsetof(FrameRecordObject, source), "number of the camera's stream, from 0"),
    whole("stamp_ns", offsetof(FrameRecordObject, stamp_ns), "global stamp"),
    whole("arrival_ns", offsetof(FrameRecordObject, arrival_ns),
          "when its host had it, on the global scale"),
    whole("sensor_ns", offsetof(FrameRecordObject, sensor_ns), "the camera's own stamp, unwrapped"),
    PyMemberDef{}};

// For tests of an algorithm by itself. `places`: the record's members, by their names.
template <class Record, class... Members>
PyObject* made_record(PyTypeObject* type, PyObject* arguments, PyObject* keywords,
                      const char* format, std::array<const char*, sizeof...(Members) + 1> names,
                      Members Record::*... places) {
  Record values{};
  if (PyArg_ParseTupleAndKeywords(arguments, keywords, format, const_cast<char**>(names.data()),
                                  &(values.*places)...) == 0) {
    return nullptr;
  }
  PyObject* const object = PyType_GenericAlloc(type, 0);
  if (object == nullptr) return nullptr;
  auto& record = *reinterpret_cast<Record*>(object);
  ((record.*places = values.*places), ...);
  return object;
}

PyObject* new_sample(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  return made_record(type, arguments, keywords, "LL|LI",
                     {"sensor_ns", "arrival_ns", "arrival_steady_ns", "exposure_us", nullptr},
                     &SampleRecord::sensor_ns, &SampleRecord::arrival_ns,
                     &SampleRecord::arrival_steady_ns, &SampleRecord::exposure_us);
}

PyObject* new_frame(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  return made_record(type, arguments, keywords, "IL|LL",
                     {"source", "stamp_ns", "arrival_ns", "sensor_ns", nullptr},
                     &FrameRecordObject::source, &FrameRecordObject::stamp_ns,
                     &FrameRecordObject::arrival_ns, &FrameRecordObject::sensor_ns);
}

PyObject* show_sample(PyObject* object) {
  const auto& record = *reinterpret_cast<SampleRecord*>(object);
  return PyUnicode_FromFormat(
      "Sample(sensor_ns=%lld, arrival_ns=%lld, arrival_steady_ns=%lld, exposure_us=%u)",
      record.sensor_ns, record.arrival_ns, record.arrival_steady_ns, record.exposure_us);
}

PyObject* show_frame(PyObject* object) {
  const auto& record = *reinterpret_cast<FrameRecordObject*>(object);
  return PyUnicode_FromFormat("Frame(source=%u, stamp_ns=%lld, arrival_ns=%lld, sensor_ns=%lld)",
                              record.source, record.stamp_ns, record.arrival_ns, record.sensor_ns);
}

PyTypeObject* made_type(const Object& module, const char* name, std::size_t size, const char* text,
                        PyMemberDef* members, newfunc make, reprfunc show) {
  std::array<PyType_Slot, 5> slots = {{{Py_tp_doc, const_cast<char*>(text)},
                                       {Py_tp_members, members},
                                       {Py_tp_new, reinterpret_cast<void*>(make)},
                                       {Py_tp_repr, reinterpret_cast<void*>(show)},
                                       {0, nullptr}}};
  PyType_Spec spec = {name, static_cast<int>(size), 0, Py_TPFLAGS_DEFAULT, slots.data()};
  return add_type(module, spec);
}

}  // namespace

RecordFunction record_function(const SharedObject& method) {
  static const SharedObject bound = shared(imported("types").attribute("MethodType"));
  const Object whole = Object::borrowed(method.get());
  if (reinterpret_cast<PyObject*>(Py_TYPE(method.get())) != bound.get()) {
    return {method, python_tuple({Object::none()}), 0};
  }
  return {shared(whole.attribute("__func__")),
          python_tuple({whole.attribute("__self__"), Object::none()}), 1};
}

void bind_records(const Object& module) {
  SampleRecord::type = made_type(module, "simbench.Sample", sizeof(SampleRecord),
                                 "A frame of one camera, as stamp() gets it.",
                                 sample_members.data(), &new_sample, &show_sample);
  FrameRecordObject::type = made_type(module, "simbench.Frame", sizeof(FrameRecordObject),
                                      "A frame of any camera, as push() of a gatherer gets it.",
                                      frame_members.data(), &new_frame, &show_frame);
}

}  // namespace simbench::python
