#include "algorithms/gathering/yoon2021.h"

#include "algorithms/gathering/front_matcher.h"

namespace simbench {
namespace {

class Yoon2021Gatherer final : public Gatherer {
 public:
  explicit Yoon2021Gatherer(const GatheringSetup& setup)
      : matcher_(setup.sources, setup.interval.count(), setup.queue_limit) {}

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    matcher_.push(nanoseconds_of(frame.stamp), frame, sink);
  }
  std::uint64_t discarded() const override { return matcher_.discarded(); }

 private:
  FrontMatcher matcher_;
};

}  // namespace

std::unique_ptr<Gatherer> make_yoon2021_gatherer(const GatheringSetup& setup) {
  return std::make_unique<Yoon2021Gatherer>(setup);
}

}  // namespace simbench
