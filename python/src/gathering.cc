// gathering in Python: a class with push(frame), which returns sets of frames.
#include "algorithms/gathering/gathering.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/registry.h"
#include "python/src/algorithms.h"
#include "python/src/python_algorithm.h"
#include "python/src/records.h"

namespace simbench::python {
namespace {

constexpr const char* kExpectedSets =
    "; expected a list of sets, each a list of the frames that belong together, or None";

class PythonGatherer final : public Gatherer {
 public:
  // With the GIL.
  PythonGatherer(std::shared_ptr<const PythonAlgorithm> algorithm, const Parameters& parameters,
                 const GatheringSetup& setup)
      : algorithm_(std::move(algorithm)), sources_(setup.sources) {
    Object keywords = keywords_of(*algorithm_, parameters);
    keywords.set("setup",
                 imported("simbench.algorithms")
                     .attribute("GatheringSetup")(setup.sources, setup.period.count(),
                                                  setup.interval.count(), setup.queue_limit));
    push_ = RecordMethod<FrameRecordObject>(
        method_of(*algorithm_, make_instance(*algorithm_, keywords), "push"));
    from_first_frame_ = has_trait(*algorithm_, "from_first_frame");
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    const WithGil gil;
    push_with_gil(frame, sink);
  }

  void push_all(std::span<const GatherFrame> frames, TimedSetSink& sink) override {
    const WithGil gil;
    for (const GatherFrame& frame : frames) {
      sink.advance_to(frame.arrival);
      push_with_gil(frame, sink);
    }
  }

  // What has come and is in no set: also the frames that still wait.
  std::uint64_t discarded() const override { return pushed_ - gathered_; }
  bool from_first_frame() const override { return from_first_frame_; }

 private:
  void push_with_gil(const GatherFrame& frame, FrameSetSink& sink) {
    ++pushed_;
    FrameRecordObject& record = push_.renewed();
    record.source = frame.source;
    record.stamp_ns = nanoseconds_of(frame.stamp);
    record.arrival_ns = nanoseconds_of(frame.arrival);
    record.sensor_ns = nanoseconds_of(frame.sensor);
    record.tag = frame.tag;
    record.is_used = false;
    PyObject* const result = push_.called();
    if (result == nullptr) throw_python_failure(*algorithm_);
    const Object sets = Object::owned(result);
    if (result == Py_None) return;
    each(result, "returned ", [&](PyObject* set) { emit(set, sink); });
  }

  // Calls use(item) with each item of a list or another sequence.
  template <class Use>
  void each(PyObject* sequence, const char* what, Use use) {
    std::optional<Items> items;
    try {
      items.emplace(sequence);
    } catch (const PythonError&) {
      throw_misuse(*algorithm_, what + shown(sequence) + kExpectedSets);
    }
    for (std::size_t i = 0; i < items->size(); ++i) use((*items)[i]);
  }

  void emit(PyObject* set, FrameSetSink& sink) {
    set_.clear();
    each(set, "returned a set that is ", [this](PyObject* item) { add(item); });
    std::ranges::sort(set_, {}, &GatherFrame::source);
    const auto twice = std::ranges::adjacent_find(set_, {}, &GatherFrame::source);
    if (twice != set_.end()) {
      throw_misuse(*algorithm_, "returned a set with two frames of source " +
                                    std::to_string(twice->source) +
                                    "; expected at most one of each");
    }
    if (set_.empty()) throw_misuse(*algorithm_, "returned a set without frames");
    gathered_ += set_.size();
    if (set_.size() == sources_) {
      sink.on_set(set_);
    } else {
      sink.on_partial_set(set_);
    }
  }

  void add(PyObject* item) {
    if (Py_TYPE(item) != FrameRecordObject::type) {
      throw_misuse(*algorithm_, "returned a set with " + shown(item) + kExpectedSets);
    }
    auto& frame = *reinterpret_cast<FrameRecordObject*>(item);
    if (frame.is_used) {
      throw_misuse(*algorithm_, "returned a frame of source " + std::to_string(frame.source) +
                                    " in two sets; expected each frame at most once");
    }
    frame.is_used = true;
    set_.push_back(
        {.source = frame.source,
         .stamp = GlobalTime(Nanoseconds(frame.stamp_ns)),
         .arrival = GlobalTime(Nanoseconds(frame.arrival_ns)),
         .sensor = std::chrono::time_point_cast<Microseconds>(
             std::chrono::time_point<time_base::Device, Nanoseconds>(Nanoseconds(frame.sensor_ns))),
         .tag = frame.tag});
  }

  std::shared_ptr<const PythonAlgorithm> algorithm_;
  std::size_t sources_;
  RecordMethod<FrameRecordObject> push_;
  bool from_first_frame_ = false;
  std::vector<GatherFrame> set_;  // that is being emitted
  std::uint64_t pushed_ = 0;
  std::uint64_t gathered_ = 0;
};

}  // namespace

void register_python_gathering(const Object& definition) {
  const auto algorithm = std::make_shared<const PythonAlgorithm>(algorithm_of(definition));
  replace_algorithm<GatheringEntry>(
      {.info = algorithm->info,
       .make = [algorithm](const Parameters& parameters,
                           const GatheringSetup& setup) -> std::unique_ptr<Gatherer> {
         const WithGil gil;
         return std::make_unique<PythonGatherer>(algorithm, parameters, setup);
       }});
}

}  // namespace simbench::python
