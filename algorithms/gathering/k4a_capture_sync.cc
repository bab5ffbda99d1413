#include <algorithm>
#include <cstdint>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

constexpr std::uint32_t kReference = 0;

class K4aGatherer final : public Gatherer {
 public:
  K4aGatherer(const GatheringSetup& setup, Nanoseconds delay)
      : period_(setup.period.count()),
        begin_(delay.count() - period_ / 4),
        limit_(setup.queue_limit.value_or(kK4aQueue)),
        queues_(setup.sources, limit_) {
    SIMBENCH_ASSERT(period_ > 0, "the frame period must be positive");
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < queues_.sources(), "a frame of a source that does not exist");
    if (queues_.size(frame.source) == limit_) give_up_front(frame.source);
    queues_.push(frame);
    match(sink);
  }

  std::uint64_t discarded() const override { return discarded_; }

 private:
  // Compares source after source with the reference's front, as far as there are fronts.
  void match(FrameSetSink& sink) {
    while (!queues_.empty(kReference)) {
      if (fitting_ == queues_.sources()) {
        sink.on_set(queues_.take_fronts());
        fitting_ = 1;
        continue;
      }
      if (queues_.empty(fitting_)) return;
      const Int128 into_window = Int128{gather_key(queues_.front(fitting_))} -
                                 gather_key(queues_.front(kReference)) - begin_;
      if (into_window > period_) {
        give_up_front(kReference);
      } else if (into_window < 0) {
        give_up_front(fitting_);
      } else {
        ++fitting_;
      }
    }
  }

  void give_up_front(std::uint32_t source) {
    queues_.pop(source);
    ++discarded_;
    fitting_ = source == kReference ? 1 : std::min(fitting_, source);
  }

  std::int64_t period_;
  std::int64_t begin_;  // of a window, after the reference's stamp
  std::uint32_t limit_;
  FrameQueues queues_;
  std::uint32_t fitting_ = 1;  // the fronts of sources below this are in their windows
  std::uint64_t discarded_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_k4a_gatherer(const GatheringSetup& setup, Nanoseconds delay) {
  return std::make_unique<K4aGatherer>(setup, delay);
}

namespace {

const char* const kK4aSource = "Azure-Kinect-Sensor-SDK src/capturesync/capturesync.c";

struct K4aSettings {
  Nanoseconds delay{0};

  void bind(ParameterBinder& parameters) {
    parameters.number("delay_us", delay, -1e6, 1e6,
                      "how much later the others are exposed than the first camera", kK4aSource);
  }
};

}  // namespace

std::vector<GatheringEntry> gathering_k4a() {
  return {with_settings<GatheringEntry>(
      {.name = "k4a",
       .family = "k4a",
       .summary = "windows of one period around the frames of the first camera",
       .source = kK4aSource},
      K4aSettings{}, [](const K4aSettings& settings, const GatheringSetup& setup) {
        return make_k4a_gatherer(setup, settings.delay);
      })};
}

}  // namespace simbench
