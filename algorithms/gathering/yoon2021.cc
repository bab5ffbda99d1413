#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class Yoon2021Gatherer final : public BlockGatherer<Yoon2021Gatherer> {
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

std::vector<GatheringEntry> gathering_yoon2021() {
  return {
      {.info = {.name = "yoon2021",
                .family = "yoon2021",
                .summary = "fronts within T_int are a set, else the earliest front is discarded",
                .source = "Yoon et al. 2021, Algorithm 3; docs/reference/paper.md section 5"},
       .make = [](const Parameters&, const GatheringSetup& setup) {
         return make_yoon2021_gatherer(setup);
       }}};
}

}  // namespace simbench
