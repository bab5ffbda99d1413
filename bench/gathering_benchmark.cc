// Time per emitted set of the gatherers, by number of sources.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>

#include "algorithms/gathering/genlock.h"
#include "algorithms/gathering/yoon2021.h"

namespace {

using simbench::GatherFrame;
using simbench::GatheringSetup;

constexpr std::int64_t kPeriodUs = 22'222;

class CountSets : public simbench::FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override {
    benchmark::DoNotOptimize(set.data());
    ++sets;
  }
  std::int64_t sets = 0;
};

// Source `source`'s frame of a pulse, up to 3 ms from it.
GatherFrame frame_of(std::int64_t pulse, std::uint32_t source) {
  const std::int64_t at_us = pulse * kPeriodUs + (pulse * 31 + source * 7919) % 3000;
  return {.source = source,
          .stamp = simbench::GlobalTime(simbench::Microseconds(at_us)),
          .sensor = simbench::DeviceTime(simbench::Microseconds(at_us)),
          .tag = pulse};
}

GatheringSetup setup_for(std::uint32_t sources) {
  return {.sources = sources,
          .period = simbench::Microseconds(kPeriodUs),
          .interval = simbench::Microseconds(kPeriodUs / 2)};
}

// Every iteration pushes the frames of one pulse; `lost_every` > 0: a frame in so many is lost.
void gather(benchmark::State& state, simbench::Gatherer& gatherer, std::int64_t lost_every) {
  const auto sources = static_cast<std::uint32_t>(state.range(0));
  CountSets sink;
  std::int64_t pulse = 0;
  std::int64_t frames = 0;
  for (auto iteration : state) {
    for (std::uint32_t source = 0; source < sources; ++source) {
      if (lost_every > 0 && ++frames % lost_every == 0) continue;
      gatherer.push(frame_of(pulse, source), sink);
    }
    ++pulse;
  }
  state.SetItemsProcessed(state.iterations() * sources);
  state.counters["sets_per_pulse"] =
      static_cast<double>(sink.sets) / static_cast<double>(state.iterations());
}

void yoon2021(benchmark::State& state) {
  const auto sources = static_cast<std::uint32_t>(state.range(0));
  gather(state, *simbench::make_yoon2021_gatherer(setup_for(sources)), 0);
}
BENCHMARK(yoon2021)->Arg(18)->Arg(1000)->Arg(18000);

void yoon2021_lossy(benchmark::State& state) {
  const auto sources = static_cast<std::uint32_t>(state.range(0));
  gather(state, *simbench::make_yoon2021_gatherer(setup_for(sources)), 5 * state.range(0) + 1);
}
BENCHMARK(yoon2021_lossy)->Arg(18)->Arg(1000);

void genlock(benchmark::State& state) {
  const auto sources = static_cast<std::uint32_t>(state.range(0));
  const auto gatherer = simbench::make_genlock_gatherer(
      setup_for(sources), simbench::GenlockOrder::Variant::kReanchored);
  gather(state, *gatherer, 0);
}
BENCHMARK(genlock)->Arg(18)->Arg(1000);

}  // namespace
