// device_time in Python: a class with stamp(sample), or with stamp_all(...) of the whole recording.
#include "algorithms/device_time/device_time.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
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
  if (PyLong_Check(result) || (!PyFloat_Check(result) && PyIndex_Check(result) != 0)) {
    int overflow = 0;
    const long long ns = PyLong_AsLongLongAndOverflow(result, &overflow);
    if (ns == -1 && PyErr_Occurred() != nullptr) throw_python_failure(algorithm);
    if (overflow == 0) return GlobalTime(Nanoseconds(ns));
  } else if (PyFloat_Check(result)) {
    const double ns = PyFloat_AsDouble(result);
    if (std::abs(ns) < kLargestNs) return GlobalTime(from_ns(ns));
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
    const Object object = make_instance(*algorithm_, keywords_of(*algorithm_, parameters));
    stamp_ = RecordMethod<SampleRecord>(method_of(*algorithm_, object, "stamp"));
    if (has_trait(*algorithm_, "on_poll")) on_poll_ = method_of(*algorithm_, object, "on_poll");
    if (has_trait(*algorithm_, "on_adjustment")) {
      on_adjustment_ = method_of(*algorithm_, object, "on_adjustment");
    }
    from_first_frame_ = has_trait(*algorithm_, "from_first_frame");
    relative_ = has_trait(*algorithm_, "relative");
  }

  GlobalTime stamp(const DeviceSample& sample) override {
    const WithGil gil;
    return stamp_with_gil(sample);
  }

  GlobalTime stamp_with_gil(const DeviceSample& sample) {
    SampleRecord& record = stamp_.renewed();
    record.sensor_ns = sensor_of(sample).count();
    record.arrival_ns = nanoseconds_of(sample.arrival);
    record.arrival_steady_ns = nanoseconds_of(sample.arrival_steady);
    record.exposure_us = sample.exposure_us;
    PyObject* const result = stamp_.called();
    if (result == nullptr) throw_python_failure(*algorithm_);
    const Object owned = Object::owned(result);
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
    const WithGil gil;
    try {
      Object::borrowed(method.get())(imported("simbench.algorithms").attribute(type)(values...));
    } catch (const PythonError& raised) {
      throw_python_failure(*algorithm_, raised);
    }
  }

  Definition algorithm_;
  Parameters parameters_;
  RecordMethod<SampleRecord> stamp_;
  SharedObject on_poll_;
  SharedObject on_adjustment_;
  bool from_first_frame_ = false;
  bool relative_ = false;
};

// Enters Python once for a block of frames.
class OnlineBank final : public EstimatorBank {
 public:
  OnlineBank(const Definition& algorithm, const Parameters& parameters, std::size_t cameras) {
    const WithGil gil;
    estimators_.reserve(cameras);
    for (std::size_t i = 0; i < cameras; ++i) {
      estimators_.push_back(std::make_unique<OnlineEstimator>(algorithm, parameters));
    }
  }

  DeviceTimeEstimator& at(std::size_t camera) override { return *estimators_[camera]; }
  void stamp(std::span<const std::uint32_t> cameras, std::span<const DeviceSample> samples,
             std::span<GlobalTime> stamps) override {
    const WithGil gil;
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

constexpr std::size_t kCell = sizeof(std::int64_t);

// A column in memory that Python may write.
Object cells_of(std::span<const DeviceSample> recording, const std::string& column) {
  const auto size = static_cast<Py_ssize_t>(recording.size() * kCell);
  Object cells = Object::owned(PyByteArray_FromStringAndSize(nullptr, size));
  char* next = PyByteArray_AsString(cells.get());
  for (const DeviceSample& sample : recording) {
    const std::int64_t value = column_value(column, sample);
    std::memcpy(next, &value, kCell);
    next += kCell;
  }
  return cells;
}

class OfflineEstimator final : public DeviceTimeEstimator {
 public:
  // With the GIL.
  OfflineEstimator(Definition algorithm, const Parameters& parameters)
      : algorithm_(std::move(algorithm)) {
    method_ = method_of(
        *algorithm_, make_instance(*algorithm_, keywords_of(*algorithm_, parameters)), "stamp_all");
    const Object traits = Object::borrowed(algorithm_->traits.get());
    columns_ = traits["columns"].as<std::vector<std::string>>();
    relative_ = has_trait(*algorithm_, "relative");
  }

  bool offline() const override { return true; }
  bool relative() const override { return relative_; }

  void learn(std::span<const DeviceSample> recording) override {
    const WithGil gil;
    try {
      const Object helpers = imported("simbench.algorithms");
      Object columns = dict();
      for (const std::string& name : columns_) {
        columns.set(name.c_str(), helpers.attribute("column_of")(cells_of(recording, name)));
      }
      const Object none = python_tuple({});
      const Object result = Object::owned(PyObject_Call(method_.get(), none.get(), columns.get()));
      keep(result, helpers.attribute("stamps_in")(result, recording.size()), recording.size());
    } catch (const PythonError& raised) {
      throw_python_failure(*algorithm_, raised);
    }
  }

  GlobalTime stamp(const DeviceSample& /*sample*/) override {
    SIMBENCH_ASSERT(next_ < stamps_.size(), "an offline estimator stamps the frames it has learnt");
    return stamps_[next_++];
  }

 private:
  static std::string expected(std::size_t frames) {
    return fmt::format(
        "; expected an array of int64 or float64 nanoseconds, one for each of the {} frames",
        frames);
  }

  // `found`: what stamps_in() of simbench/algorithms.py made of the result.
  void keep(const Object& result, const Object& found, std::size_t frames) {
    if (PyUnicode_Check(found.get())) {
      const auto what = found.as<std::string>();
      throw_misuse(*algorithm_,
                   "returned " + (what.empty() ? shown(result.get()) : what) + expected(frames));
    }
    const auto [is_whole, bytes] = found.as<std::pair<bool, Object>>();
    const char* next = bytes_in(bytes.get()).data();
    stamps_.resize(frames);
    next_ = 0;
    for (std::size_t i = 0; i < frames; ++i, next += kCell) {
      stamps_[i] = is_whole ? GlobalTime(Nanoseconds(cell<std::int64_t>(next)))
                            : checked(cell<double>(next), i, frames);
    }
  }

  template <class Value>
  static Value cell(const char* bytes) {
    static_assert(sizeof(Value) == kCell);
    Value value{};
    std::memcpy(&value, bytes, kCell);
    return value;
  }

  GlobalTime checked(double ns, std::size_t frame, std::size_t frames) const {
    if (std::abs(ns) < kLargestNs) return GlobalTime(from_ns(ns));
    throw_misuse(*algorithm_,
                 fmt::format("returned {} for frame {}{}", ns, frame, expected(frames)));
  }

  Definition algorithm_;
  SharedObject method_;
  std::vector<std::string> columns_;
  bool relative_ = false;
  std::vector<GlobalTime> stamps_;
  std::size_t next_ = 0;
};

}  // namespace

void register_python_device_time(const Object& definition) {
  const auto algorithm = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  replace_algorithm<DeviceTimeEntry>(
      {.info = algorithm->info,
       .make = [algorithm](const Parameters& parameters) -> std::unique_ptr<DeviceTimeEstimator> {
         const WithGil gil;
         if (algorithm->method == "stamp") {
           return std::make_unique<OnlineEstimator>(algorithm, parameters);
         }
         return std::make_unique<OfflineEstimator>(algorithm, parameters);
       }});
}

}  // namespace simbench::python
