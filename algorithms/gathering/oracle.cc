#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class OracleGatherer final : public BlockGatherer<OracleGatherer> {
 public:
  explicit OracleGatherer(const GatheringSetup& setup)
      : matcher_(setup.sources, /*tolerance=*/1, setup.queue_limit) {}

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    if (frame.tag < 0) {
      ++without_pulse_;
    } else {
      matcher_.push(frame.tag, frame, sink);
    }
  }
  std::uint64_t discarded() const override { return without_pulse_ + matcher_.discarded(); }

 private:
  FrontMatcher matcher_;  // over pulses
  std::uint64_t without_pulse_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_oracle_gatherer(const GatheringSetup& setup) {
  return std::make_unique<OracleGatherer>(setup);
}

std::vector<GatheringEntry> gathering_oracle() {
  return {{.info = {.name = "oracle",
                    .family = "oracle",
                    .summary = "frames of one true pulse",
                    .source = "limit: no policy can find more sets",
                    .needs = {Need::kTruth}},
           .make = [](const Parameters&, const GatheringSetup& setup) {
             return make_oracle_gatherer(setup);
           }}};
}

}  // namespace simbench
