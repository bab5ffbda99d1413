// device_time in Python: a class with stamp(sample), or with stamp_all(...) of the whole recording.
#include "algorithms/device_time/device_time.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "python/src/algorithms.h"
#include "python/src/python_algorithm.h"
#include "python/src/records.h"

namespace simbench::python {
namespace {

using Definition = std::shared_ptr<const PythonAlgorithm>;

constexpr double kLargestNs = 9.2e18;  // within 64 bits

Nanoseconds sensor_of(const DeviceSample& sample) {
  return std::chrono::duration_cast<Nanoseconds>(sample.sensor.time_since_epoch());
}

// What stamp() returned, in nanoseconds.
GlobalTime global_time(const PythonAlgorithm& algorithm, PyObject* result) {
  if (PyFloat_Check(result)) {
    const double ns = PyFloat_AS_DOUBLE(result);
    if (std::abs(ns) < kLargestNs) return GlobalTime(from_ns(ns));
  } else if (PyIndex_Check(result)) {
    int overflow = 0;
    const long long ns = PyLong_AsLongLongAndOverflow(result, &overflow);
    if (ns == -1 && PyErr_Occurred() != nullptr) throw_python_failure(algorithm);
    if (overflow == 0) return GlobalTime(Nanoseconds(ns));
  }
  throw_misuse(algorithm,
               "returned " + shown(result) +
                   "; expected the global stamp: an int or a finite float of nanoseconds");
}

class OnlineEstimator final : public DeviceTimeEstimator {
 public:
  // With the GIL.
  OnlineEstimator(Definition algorithm, const Parameters& parameters)
      : algorithm_(std::move(algorithm)), parameters_(parameters) {
    const py::object object = make_instance(*algorithm_, parameters);
    method_ = method_of(*algorithm_, object, "stamp");
    if (has_trait(*algorithm_, "on_poll")) on_poll_ = method_of(*algorithm_, object, "on_poll");
    if (has_trait(*algorithm_, "on_adjustment")) {
      on_adjustment_ = method_of(*algorithm_, object, "on_adjustment");
    }
    from_first_frame_ = has_trait(*algorithm_, "from_first_frame");
    relative_ = has_trait(*algorithm_, "relative");
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    const py::gil_scoped_acquire gil;
    return stamp_with_gil(sample);
  }

  GlobalTime stamp_with_gil(const DeviceSample& sample) {
    SampleRecord& record = renewed<SampleRecord>(record_);
    record.sensor_ns = sensor_of(sample).count();
    record.arrival_ns = nanoseconds_of(sample.arrival);
    record.arrival_steady_ns = nanoseconds_of(sample.arrival_steady);
    record.exposure_us = sample.exposure_us;
    PyObject* const result = PyObject_CallOneArg(method_.get(), record_.get());
    if (result == nullptr) throw_python_failure(*algorithm_);
    const py::object owned = py::reinterpret_steal<py::object>(result);
    return global_time(*algorithm_, result);
  }

  bool from_first_frame() const override { return from_first_frame_; }
  bool relative() const override { return relative_; }

  void on_poll(const PollSample& poll) override {
    if (!on_poll_) return;
    const auto device = std::chrono::duration_cast<Nanoseconds>(poll.device.time_since_epoch());
    report(on_poll_, "Poll", device.count(), nanoseconds_of(poll.t0), nanoseconds_of(poll.t1),
           nanoseconds_of(poll.t0_steady), nanoseconds_of(poll.t1_steady));
  }

  void on_adjustment(const ClockAdjustment& adjustment) override {
    if (!on_adjustment_) return;
    report(on_adjustment_, "Adjustment", nanoseconds_of(adjustment.at),
           nanoseconds_of(adjustment.before), nanoseconds_of(adjustment.after),
           adjustment.rate_ppb);
  }

  std::unique_ptr<EstimatorBank> bank(std::size_t cameras) const override;

 private:
  template <class... Values>
  void report(const SharedObject& method, const char* type, Values... values) {
    const py::gil_scoped_acquire gil;
    try {
      const py::object record = py::module_::import("simbench.algorithms").attr(type)(values...);
      py::handle(method.get())(record);
    } catch (py::error_already_set& raised) {
      raised.restore();
      throw_python_failure(*algorithm_);
    }
  }

  Definition algorithm_;
  Parameters parameters_;
  SharedObject method_;
  SharedObject on_poll_;
  SharedObject on_adjustment_;
  RecordReference record_;
  bool from_first_frame_ = false;
  bool relative_ = false;
};

// Enters Python once for a block of frames.
class OnlineBank final : public EstimatorBank {
 public:
  OnlineBank(const Definition& algorithm, const Parameters& parameters, std::size_t cameras) {
    const py::gil_scoped_acquire gil;
    estimators_.reserve(cameras);
    for (std::size_t i = 0; i < cameras; ++i) {
      estimators_.push_back(std::make_unique<OnlineEstimator>(algorithm, parameters));
    }
  }

  DeviceTimeEstimator& at(std::size_t camera) override { return *estimators_[camera]; }
  void stamp(std::span<const std::uint32_t> cameras, std::span<const DeviceSample> samples,
             std::span<GlobalTime> stamps) override {
    const py::gil_scoped_acquire gil;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      stamps[i] = estimators_[cameras[i]]->stamp_with_gil(samples[i]);
    }
  }

 private:
  std::vector<std::unique_ptr<OnlineEstimator>> estimators_;
};

std::unique_ptr<EstimatorBank> OnlineEstimator::bank(std::size_t cameras) const {
  return std::make_unique<OnlineBank>(algorithm_, parameters_, cameras);
}

// One of the columns that stamp_all() may ask for by the name of an argument.
std::int64_t column_value(const std::string& column, const DeviceSample& sample) {
  if (column == "sensor_ns") return sensor_of(sample).count();
  if (column == "arrival_ns") return nanoseconds_of(sample.arrival);
  if (column == "arrival_steady_ns") return nanoseconds_of(sample.arrival_steady);
  SIMBENCH_ASSERT(column == "exposure_us", "the decorator has checked the arguments");
  return sample.exposure_us;
}

class OfflineEstimator final : public DeviceTimeEstimator {
 public:
  // With the GIL.
  OfflineEstimator(Definition algorithm, const Parameters& parameters)
      : algorithm_(std::move(algorithm)) {
    method_ = method_of(*algorithm_, make_instance(*algorithm_, parameters), "stamp_all");
    const py::handle traits(algorithm_->traits.get());
    columns_ = traits["columns"].cast<std::vector<std::string>>();
    relative_ = has_trait(*algorithm_, "relative");
  }

  bool offline() const override { return true; }
  bool relative() const override { return relative_; }

  void learn(std::span<const DeviceSample> recording) override {
    const py::gil_scoped_acquire gil;
    const auto frames = static_cast<py::ssize_t>(recording.size());
    py::dict columns;
    for (const std::string& name : columns_) {
      py::array_t<std::int64_t> column(frames);
      std::int64_t* value = column.mutable_data();
      for (const DeviceSample& sample : recording) *value++ = column_value(name, sample);
      columns[py::str(name)] = column;
    }
    PyObject* const result = PyObject_Call(method_.get(), py::tuple(0).ptr(), columns.ptr());
    if (result == nullptr) throw_python_failure(*algorithm_);
    keep(py::reinterpret_steal<py::object>(result), recording.size());
  }

  GlobalTime stamp(const DeviceSample& /*sample*/) override {
    SIMBENCH_ASSERT(next_ < stamps_.size(), "an offline estimator stamps the frames it has learnt");
    return stamps_[next_++];
  }

 private:
  static constexpr const char* kExpected =
      "; expected an array of int64 or float64 nanoseconds, one for each frame";

  void keep(const py::object& result, std::size_t frames) {
    if (!py::isinstance<py::array>(result)) {
      throw_misuse(*algorithm_, "returned " + shown(result.ptr()) + kExpected);
    }
    const auto array = py::reinterpret_borrow<py::array>(result);
    const bool is_whole = py::isinstance<py::array_t<std::int64_t>>(array);
    if (!is_whole && !py::isinstance<py::array_t<double>>(array)) {
      const std::string type = py::str(array.dtype());
      throw_misuse(*algorithm_, "returned an array of " + type + kExpected);
    }
    if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != frames) {
      const std::string shape = py::str(array.attr("shape"));
      throw_misuse(*algorithm_, "returned an array of shape " + shape + kExpected + ", which are " +
                                    std::to_string(frames));
    }
    stamps_.resize(frames);
    next_ = 0;
    if (is_whole) {
      const auto values = py::array_t<std::int64_t>(array).unchecked<1>();
      for (std::size_t i = 0; i < frames; ++i) stamps_[i] = GlobalTime(Nanoseconds(values(i)));
    } else {
      const auto values = py::array_t<double>(array).unchecked<1>();
      for (std::size_t i = 0; i < frames; ++i) stamps_[i] = checked(values(i), i);
    }
  }

  GlobalTime checked(double ns, std::size_t frame) const {
    if (std::abs(ns) < kLargestNs) return GlobalTime(from_ns(ns));
    throw_misuse(*algorithm_, "returned " + std::to_string(ns) + " for frame " +
                                  std::to_string(frame) + kExpected);
  }

  Definition algorithm_;
  SharedObject method_;
  std::vector<std::string> columns_;
  bool relative_ = false;
  std::vector<GlobalTime> stamps_;
  std::size_t next_ = 0;
};

}  // namespace

void register_python_device_time(const py::dict& definition) {
  const auto algorithm = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  replace_algorithm<DeviceTimeEntry>(
      {.info = algorithm->info,
       .make = [algorithm](const Parameters& parameters) -> std::unique_ptr<DeviceTimeEstimator> {
         const py::gil_scoped_acquire gil;
         if (algorithm->method == "stamp") {
           return std::make_unique<OnlineEstimator>(algorithm, parameters);
         }
         return std::make_unique<OfflineEstimator>(algorithm, parameters);
       }});
}

}  // namespace simbench::python
