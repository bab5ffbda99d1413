#include "algorithms/gathering/oracle.h"

#include "algorithms/gathering/front_matcher.h"

namespace simbench {
namespace {

class OracleGatherer final : public Gatherer {
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

}  // namespace simbench
