// Time per pulse of every registered gatherer, by number of sources.
//
// "clean": one frame of every source per pulse, so a set per pulse. "lossy": about one pulse in
// five lacks a frame. "equal": the same without noise, so all stamps of a pulse are equal. "noisy":
// stamps over half a period, so that fronts must be searched.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "algorithms/coded_trigger/coded_pulses.h"
#include "algorithms/registry.h"

namespace {

using simbench::GatherFrame;
using simbench::GatheringEntry;

constexpr std::int64_t kPeriodUs = 22'222;

class CountSets : public simbench::FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override {
    benchmark::DoNotOptimize(set.data());
    ++sets;
  }
  void on_partial_set(std::span<const GatherFrame> set) override {
    benchmark::DoNotOptimize(set.data());
    ++partial_sets;
  }
  std::int64_t sets = 0;
  std::int64_t partial_sets = 0;
};

struct Stream {
  std::int64_t noise_us = 3000;
  std::int64_t lost_every = 0;  // pulses that lack a frame: one in so many; 0: none
};

// The trigger has a code, which the sensor stamps show.
const std::shared_ptr<const simbench::CodedPulses>& coded_pulses() {
  static const auto pulses = std::make_shared<const simbench::CodedPulses>(
      simbench::CodedPulses{.code = simbench::TriggerCode::position(
                                simbench::Microseconds(kPeriodUs), 12, simbench::from_us(50))});
  return pulses;
}

// Source `source`'s frame of a pulse, up to `noise_us` from it.
GatherFrame frame_of(std::int64_t pulse, std::uint32_t source, std::int64_t noise_us) {
  const std::int64_t at_us = pulse * kPeriodUs + (pulse * 31 + source * 7919) % noise_us;
  return {.source = source,
          .stamp = simbench::GlobalTime(simbench::Microseconds(at_us)),
          .arrival = simbench::GlobalTime(simbench::Microseconds(at_us)),
          .sensor = simbench::DeviceTime(simbench::Microseconds(
              pulse * kPeriodUs + coded_pulses()->code.shift(pulse).count() / 1000)),
          .tag = pulse};
}

// Every iteration pushes the frames of one pulse.
void gather(benchmark::State& state, const GatheringEntry& entry, const Stream& stream) {
  const auto sources = static_cast<std::uint32_t>(state.range(0));
  const auto gatherer = entry.make(simbench::check_parameters(entry.info.parameters, {}),
                                   {.sources = sources,
                                    .period = simbench::Microseconds(kPeriodUs),
                                    .interval = simbench::Microseconds(kPeriodUs / 2),
                                    .pulses = coded_pulses()});
  CountSets sink;
  std::int64_t pulse = 0;
  // Not of interest: queues that grow, and the search for a place in the code.
  constexpr std::int64_t kWarmUpPulses = 60;
  for (; pulse < kWarmUpPulses; ++pulse) {
    for (std::uint32_t source = 0; source < sources; ++source) {
      gatherer->push(frame_of(pulse, source, stream.noise_us), sink);
    }
  }
  sink = CountSets();
  for (auto iteration : state) {
    const bool lossy = stream.lost_every > 0 && pulse % stream.lost_every == 0;
    const std::int64_t lost = lossy ? pulse % sources : -1;
    for (std::uint32_t source = 0; source < sources; ++source) {
      if (source != lost) gatherer->push(frame_of(pulse, source, stream.noise_us), sink);
    }
    ++pulse;
  }
  const auto per_pulse = [&](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(state.iterations());
  };
  state.SetItemsProcessed(state.iterations() * sources);
  state.counters["sets_per_pulse"] = per_pulse(sink.sets);
  state.counters["partial_per_pulse"] = per_pulse(sink.partial_sets);
}

void add_benchmarks() {
  const struct {
    const char* name = "";
    Stream stream;
  } streams[] = {{"clean", {}},
                 {"lossy", {.lost_every = 5}},
                 {"equal", {.noise_us = 1, .lost_every = 5}},
                 {"noisy", {.noise_us = 10'000}}};
  for (const GatheringEntry& entry : simbench::algorithms<simbench::GatheringEntry>()) {
    for (const auto& [name, stream] : streams) {
      benchmark::RegisterBenchmark(
          (entry.info.name + "/" + name).c_str(),
          [&entry, stream = stream](benchmark::State& state) { gather(state, entry, stream); })
          ->Arg(18)
          ->Arg(1000);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  add_benchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
