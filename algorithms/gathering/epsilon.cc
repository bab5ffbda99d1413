#include <cstdint>
#include <limits>
#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr std::int64_t kNoFront = std::numeric_limits<std::int64_t>::max();

class EpsilonGatherer final : public Gatherer {
 public:
  explicit EpsilonGatherer(const GatheringSetup& setup)
      : epsilon_(setup.interval.count()),
        limit_(setup.queue_limit.value_or(kRosQueue)),
        queues_(setup.sources, limit_),
        fronts_(setup.sources) {
    SIMBENCH_ASSERT(epsilon_ >= 0, "no set is narrower than equal stamps");
    given_up_.reserve(setup.sources);
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < queues_.sources(), "a frame of a source that does not exist");
    if (queues_.size(frame.source) == limit_) give_up_front(frame.source);
    queues_.push(frame);
    if (queues_.size(frame.source) == 1) fronts_.set(frame.source, gather_key(frame));
    while (queues_.all_waiting()) match(sink);
  }

  std::uint64_t discarded() const override { return discarded_; }

 private:
  void match(FrameSetSink& sink) {
    const std::int64_t earliest = fronts_.key(fronts_.earliest());
    if (fronts_.key(fronts_.latest()) - earliest > epsilon_) {
      give_up_near(earliest);
      return;
    }
    sink.on_set(queues_.take_fronts());
    fronts_.forget();
    for (std::uint32_t source = 0; source < queues_.sources(); ++source) note_front(source);
  }

  // Discards the present fronts only, not those that come up behind them, however near.
  void give_up_near(std::int64_t earliest) {
    for (;;) {
      const std::uint32_t source = fronts_.earliest();
      if (fronts_.key(source) == kNoFront || fronts_.key(source) - earliest > epsilon_) break;
      fronts_.set(source, kNoFront);
      given_up_.push_back(source);
    }
    for (const std::uint32_t source : given_up_) give_up_front(source);
    given_up_.clear();
  }

  void give_up_front(std::uint32_t source) {
    queues_.pop(source);
    ++discarded_;
    note_front(source);
  }

  void note_front(std::uint32_t source) {
    fronts_.set(source, queues_.empty(source) ? kNoFront : gather_key(queues_.front(source)));
  }

  std::int64_t epsilon_;
  std::uint32_t limit_;
  FrameQueues queues_;
  FrontTournament fronts_;
  std::vector<std::uint32_t> given_up_;  // empty but during give_up_near
  std::uint64_t discarded_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_epsilon_gatherer(const GatheringSetup& setup) {
  return std::make_unique<EpsilonGatherer>(setup);
}

std::vector<GatheringEntry> gathering_epsilon() {
  return {{.info = {.name = "epsilon",
                    .family = "epsilon",
                    .summary =
                        "fronts within T_int are a set, else all near the earliest are discarded",
                    .source = "ros2/message_filters sync_policies/approximate_epsilon_time"},
           .make = [](const Parameters&, const GatheringSetup& setup) {
             return make_epsilon_gatherer(setup);
           }}};
}

}  // namespace simbench
