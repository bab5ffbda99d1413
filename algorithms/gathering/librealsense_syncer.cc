#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "algorithms/ports/assert.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

constexpr std::int64_t kGapsUntilInactive = 7;
constexpr std::int64_t kNeverSeen = std::numeric_limits<std::int64_t>::max();

class LibrealsenseGatherer final : public Gatherer {
 public:
  explicit LibrealsenseGatherer(const GatheringSetup& setup)
      : gap_(setup.period.count()),
        limit_(setup.queue_limit.value_or(kLibrealsenseQueue)),
        queues_(setup.sources, limit_),
        expected_(setup.sources, kNeverSeen) {
    SIMBENCH_ASSERT(gap_ > 0, "the frame period must be positive");
    group_.reserve(setup.sources);
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) override {
    SIMBENCH_ASSERT(frame.source < queues_.sources(), "a frame of a source that does not exist");
    if (queues_.size(frame.source) == limit_) {
      queues_.pop(frame.source);
      ++discarded_;
      find_range();
    }
    queues_.push(frame);
    newest_ = gather_key(frame);
    expected_[frame.source] = std::min(newest_ + gap_, kFarthestKey);
    if (queues_.size(frame.source) == 1) {
      earliest_ = fronts_ == 0 ? newest_ : std::min(earliest_, newest_);
      latest_ = fronts_ == 0 ? newest_ : std::max(latest_, newest_);
      ++fronts_;
    }
    while (fronts_ > 0 && (!are_equivalent(earliest_, latest_) || !must_wait())) emit_group(sink);
  }

  std::uint64_t discarded() const override { return discarded_; }

 private:
  // Less than half a gap apart.
  bool are_equivalent(std::int64_t earlier, std::int64_t later) const {
    return later - earlier < gap_ - gap_ / 2;
  }

  // Whether a source without a front may still deliver a member of the group. The search begins
  // with the source awaited last, so that it goes around once per set, not once per frame.
  bool must_wait() {
    for (std::uint32_t looked_at = 0; looked_at < queues_.sources(); ++looked_at) {
      if (queues_.empty(awaited_) && is_expected(awaited_)) return true;
      if (++awaited_ == queues_.sources()) awaited_ = 0;
    }
    return false;
  }

  bool is_expected(std::uint32_t source) const {
    const std::int64_t expected = expected_[source];
    if (expected == kNeverSeen) return false;
    if (newest_ > expected) return newest_ - expected < kGapsUntilInactive * gap_;
    return are_equivalent(std::min(earliest_, expected), std::max(earliest_, expected));
  }

  void emit_group(FrameSetSink& sink) {
    group_.clear();
    for (std::uint32_t source = 0; source < queues_.sources(); ++source) {
      if (queues_.empty(source)) continue;
      const GatherFrame& front = queues_.front(source);
      if (!are_equivalent(earliest_, gather_key(front))) continue;
      group_.push_back(front);
      queues_.pop(source);
    }
    find_range();
    if (group_.size() == queues_.sources()) {
      sink.on_set(group_);
    } else {
      sink.on_partial_set(group_);
    }
  }

  void find_range() {
    fronts_ = 0;
    for (std::uint32_t source = 0; source < queues_.sources(); ++source) {
      if (queues_.empty(source)) continue;
      const std::int64_t key = gather_key(queues_.front(source));
      earliest_ = fronts_ == 0 ? key : std::min(earliest_, key);
      latest_ = fronts_ == 0 ? key : std::max(latest_, key);
      ++fronts_;
    }
  }

  std::int64_t gap_;
  std::uint32_t limit_;
  FrameQueues queues_;
  std::vector<std::int64_t> expected_;  // by source: stamp of its next frame, or kNeverSeen
  std::uint32_t fronts_ = 0;            // sources that have one
  std::int64_t earliest_ = 0;           // of the fronts
  std::int64_t latest_ = 0;
  std::int64_t newest_ = 0;    // stamp of the last arrival
  std::uint32_t awaited_ = 0;  // the source awaited last
  std::vector<GatherFrame> group_;
  std::uint64_t discarded_ = 0;
};

}  // namespace

std::unique_ptr<Gatherer> make_librealsense_gatherer(const GatheringSetup& setup) {
  return std::make_unique<LibrealsenseGatherer>(setup);
}

std::vector<GatheringEntry> gathering_librealsense() {
  return {{.info = {.name = "librealsense",
                    .family = "librealsense",
                    .summary = "half a period around the earliest front; emits partial sets",
                    .source = "librealsense src/sync.cpp; docs/reference/d455.md section 6"},
           .make = [](const Parameters&, const GatheringSetup& setup) {
             return make_librealsense_gatherer(setup);
           }}};
}

}  // namespace simbench
