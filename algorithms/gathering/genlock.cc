#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class GenlockGatherer final : public BlockGatherer<GenlockGatherer> {
 public:
  GenlockGatherer(const GatheringSetup& setup, GenlockOrder::Variant variant)
      : orders_(setup.sources, GenlockOrder(setup.period, variant)),
        matcher_(setup.sources, /*tolerance=*/1, setup.queue_limit) {}

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < orders_.size(), "a frame of a source that does not exist");
    matcher_.push(orders_[frame.source].next(frame.sensor), frame, sink);
  }
  std::uint64_t discarded() const override { return matcher_.discarded(); }
  bool from_first_frame() const override { return true; }

 private:
  std::vector<GenlockOrder> orders_;  // by source
  FrontMatcher matcher_;              // over pulse indices
};

}  // namespace

std::unique_ptr<Gatherer> make_genlock_gatherer(const GatheringSetup& setup,
                                                GenlockOrder::Variant variant) {
  return std::make_unique<GenlockGatherer>(setup, variant);
}

namespace {

GatheringEntry genlock(const char* name, GenlockOrder::Variant variant, const char* summary) {
  return {.info = {.name = name,
                   .family = "genlock",
                   .summary = summary,
                   .source = "Yoon et al. 2021, GenLock; docs/reference/paper.md section 8"},
          .make = [variant](const Parameters&, const GatheringSetup& setup) {
            return make_genlock_gatherer(setup, variant);
          }};
}

}  // namespace

std::vector<GatheringEntry> gathering_genlock() {
  return {
      genlock("genlock", GenlockOrder::Variant::kReanchored,
              "frames of one trigger pulse, counted from frame to frame"),
      genlock("genlock_printed", GenlockOrder::Variant::kFirstStamp,
              "frames of one trigger pulse, counted from the first stamp: drifts (as printed)")};
}

}  // namespace simbench
