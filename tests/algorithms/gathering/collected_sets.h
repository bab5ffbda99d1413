// What a gatherer emitted, kept for the tests of gathering.
#ifndef SIMBENCH_TESTS_ALGORITHMS_GATHERING_COLLECTED_SETS_H_
#define SIMBENCH_TESTS_ALGORITHMS_GATHERING_COLLECTED_SETS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"

namespace simbench {

class CollectedSets : public FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override {
    sets.emplace_back(set.begin(), set.end());
    all.push_back(sets.back());
  }
  void on_partial_set(std::span<const GatherFrame> set) override {
    partial.emplace_back(set.begin(), set.end());
    all.push_back(partial.back());
  }

  // The tags of each set, in order of source.
  std::vector<std::vector<std::int64_t>> tags() const {
    std::vector<std::vector<std::int64_t>> result;
    for (const std::vector<GatherFrame>& set : sets) {
      result.emplace_back();
      for (const GatherFrame& frame : set) result.back().push_back(frame.tag);
    }
    return result;
  }

  // Sets whose frames all have one tag.
  std::int64_t pure() const {
    std::int64_t count = 0;
    for (const std::vector<std::int64_t>& set : tags()) {
      bool same = true;
      for (const std::int64_t tag : set) same = same && tag == set.front();
      count += same ? 1 : 0;
    }
    return count;
  }

  std::vector<std::vector<GatherFrame>> sets;
  std::vector<std::vector<GatherFrame>> partial;
  std::vector<std::vector<GatherFrame>> all;  // both, in order of emission
};

inline GatherFrame frame_at(std::uint32_t source, double stamp_ms, std::int64_t tag) {
  return {.source = source,
          .stamp = GlobalTime(from_ms(stamp_ms)),
          .sensor = DeviceTime(std::chrono::duration_cast<Microseconds>(from_ms(stamp_ms))),
          .tag = tag};
}

}  // namespace simbench

#endif  // SIMBENCH_TESTS_ALGORITHMS_GATHERING_COLLECTED_SETS_H_
