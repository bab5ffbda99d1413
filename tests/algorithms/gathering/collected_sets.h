// What a gatherer emitted, and how gatherers are set up, for the tests of gathering.
#pragma once

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

// The period of 45 Hz as the paper rounds it, and a shorter one that is no multiple of its half.
inline constexpr double kPeriodMs = 22;
inline constexpr double kShortPeriodMs = 20;

// With an interval of half a period.
inline GatheringSetup setup_of(std::uint32_t sources, std::uint32_t queue_limit = 64,
                               double period_ms = kPeriodMs) {
  return {.sources = sources,
          .period = from_ms(period_ms),
          .interval = from_ms(period_ms / 2),
          .queue_limit = queue_limit};
}
inline GatheringSetup short_setup(std::uint32_t sources, std::uint32_t queue_limit = 16) {
  return setup_of(sources, queue_limit, kShortPeriodMs);
}

}  // namespace simbench
