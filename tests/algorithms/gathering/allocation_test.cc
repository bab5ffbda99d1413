// Once warm, gathering allocates nothing, be the streams clean or not.
#include <gtest/gtest.h>

#include <cstdint>
#include <span>

#include "algorithms/registry.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"
#include "tests/nonempty.h"
#include "tests/sim/engine/counting_new.cc"  // NOLINT(bugprone-suspicious-include): its counter

namespace simbench {
namespace {

class Ignore final : public FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> /*set*/) override {}
};

// A frame in seven is lost, and the last source is silent for a third of the time.
void push_lossy_pulses(Gatherer& gatherer, std::int64_t first, std::int64_t count) {
  constexpr std::uint32_t kSources = 6;
  Ignore sink;
  std::int64_t frames = 0;
  for (std::int64_t pulse = first; pulse < first + count; ++pulse) {
    for (std::uint32_t source = 0; source < kSources; ++source) {
      const bool silent = source == kSources - 1 && pulse % 300 >= 200;
      if (++frames % 7 == 0 || silent) continue;
      const Microseconds at(pulse * 20'000 + (pulse * 7919 + source * 104'729) % 6000);
      gatherer.push({.source = source,
                     .stamp = GlobalTime(at),
                     .arrival = GlobalTime(at),
                     .sensor = DeviceTime(at),
                     .tag = pulse},
                    sink);
    }
  }
}

TEST(GatheringAllocations, NoneOnceWarm) {
  const GatheringSetup setup = {.sources = 6,
                                .period = from_ms(20),
                                .interval = from_ms(10),
                                .queue_limit = 16,
                                .pulses = pulses_of(short_code())};
  for (const GatheringEntry& entry : nonempty(algorithms<GatheringEntry>())) {
    const auto gatherer = entry.make(check_parameters(entry.info.parameters, {}), setup);
    push_lossy_pulses(*gatherer, 0, 900);
    const std::uint64_t before = sim::allocations();
    push_lossy_pulses(*gatherer, 900, 900);
    EXPECT_EQ(sim::allocations() - before, 0U) << entry.info.name;
  }
}

}  // namespace
}  // namespace simbench
