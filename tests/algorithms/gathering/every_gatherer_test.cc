// What every registered gatherer promises, whatever its policy.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/registry.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

// All cameras' clocks are that of one host, and read at a pulse.
void read_clocks(Gatherer& gatherer, std::uint32_t sources, std::int64_t pulse) {
  if (!gatherer.wants_evidence()) return;
  const Nanoseconds at = from_ms(static_cast<double>(pulse) * kShortPeriodMs);
  for (std::uint32_t source = 0; source < sources; ++source) {
    gatherer.on_poll(source, {.device = DeviceTime(std::chrono::duration_cast<Microseconds>(at)),
                              .t0_steady = SteadyTime(at),
                              .t1_steady = SteadyTime(at)});
  }
}

class EveryGatherer : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Gatherer> make(GatheringSetup setup) {
    setup.pulses = pulses_of(short_code());
    const GatheringEntry& entry = *find_algorithm<GatheringEntry>(GetParam());
    auto gatherer = entry.make(check_parameters(entry.info.parameters, {}), setup);
    read_clocks(*gatherer, setup.sources, 0);
    return gatherer;
  }
};

std::vector<std::string> gatherer_names() {
  std::vector<std::string> all;
  for (const GatheringEntry& entry : algorithms<GatheringEntry>()) all.push_back(entry.info.name);
  return all;
}

// A frame of a world without noise, whose trigger is coded: its sensor stamp tells so.
GatherFrame pulse_frame(std::uint32_t source, std::int64_t pulse) {
  static const TriggerCode code = short_code();
  GatherFrame frame = frame_at(source, static_cast<double>(pulse) * kShortPeriodMs, pulse);
  frame.sensor += std::chrono::duration_cast<Microseconds>(code.shift(pulse));
  return frame;
}

// Pushes them, source after source.
void push_pulses(Gatherer& gatherer, std::uint32_t sources, std::int64_t first, std::int64_t count,
                 CollectedSets& out) {
  for (std::int64_t pulse = first; pulse < first + count; ++pulse) {
    for (std::uint32_t source = 0; source < sources; ++source) {
      gatherer.push(pulse_frame(source, pulse), out);
    }
  }
}

using FrameName = std::pair<std::uint32_t, std::int64_t>;  // source, number of its push

// Every frame at most once, sets in order of source, and the sum of what was used, given up and
// can still wait is what came in. `pushed` frames were numbered in `sensor`, by source.
void expect_sound(const CollectedSets& out, const Gatherer& gatherer, const GatheringSetup& setup,
                  std::uint64_t pushed, const std::string& context) {
  std::set<FrameName> used;
  for (const std::vector<GatherFrame>& set : out.all) {
    ASSERT_FALSE(set.empty()) << context;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const std::int64_t number = set[i].sensor.time_since_epoch().count();
      ASSERT_TRUE(used.insert({set[i].source, number}).second) << context << ": used twice";
      ASSERT_TRUE(i == 0 || set[i - 1].source < set[i].source) << context << ": order of sources";
    }
  }
  for (const std::vector<GatherFrame>& set : out.sets) ASSERT_EQ(set.size(), setup.sources);
  for (const std::vector<GatherFrame>& set : out.partial) ASSERT_LT(set.size(), setup.sources);
  ASSERT_LE(used.size() + gatherer.discarded(), pushed) << context;
  ASSERT_LE(pushed - used.size() - gatherer.discarded(),
            std::uint64_t{setup.sources} * setup.queue_limit.value())
      << context << ": memory is not bounded";
}

// Frames of a source are used in the order in which they came.
void expect_in_order(const CollectedSets& out, const std::string& context) {
  std::map<std::uint32_t, std::int64_t> last;
  for (const std::vector<GatherFrame>& set : nonempty(out.all)) {
    for (const GatherFrame& frame : set) {
      const std::int64_t number = frame.sensor.time_since_epoch().count();
      const auto [entry, is_first] = last.try_emplace(frame.source, -1);
      ASSERT_GT(number, entry->second) << context << ", source " << frame.source;
      entry->second = number;
    }
  }
}

struct Arrival {
  double at_ms = 0;
  GatherFrame frame;
};

// Noisy stamps, drops and delays; frames of a source stay in order, and so do its stamps.
std::vector<GatherFrame> noisy_frames(std::uint32_t sources, std::int64_t pulses, double sigma_ms,
                                      double drop, std::uint32_t seed) {
  boost::random::mt19937 random(seed);
  boost::random::normal_distribution<double> noise_ms(0, sigma_ms);
  boost::random::uniform_01<double> uniform;
  std::vector<Arrival> arrivals;
  for (std::uint32_t source = 0; source < sources; ++source) {
    double last_ms = 0;
    double stamp_ms = -1000;
    for (std::int64_t pulse = 0; pulse < pulses; ++pulse) {
      const double at_ms = static_cast<double>(pulse) * kShortPeriodMs;
      stamp_ms = std::max(stamp_ms + 0.001, at_ms + noise_ms(random));
      last_ms = std::max(last_ms, at_ms + 8 + 20 * uniform(random));
      if (uniform(random) < drop) continue;
      arrivals.push_back({last_ms, frame_at(source, stamp_ms, pulse)});
      // Genlock and a coded trigger count from here: half-period noise is not what they are for.
      arrivals.back().frame.sensor = pulse_frame(source, pulse + 1).sensor;
    }
  }
  std::ranges::stable_sort(arrivals, {}, &Arrival::at_ms);
  std::vector<GatherFrame> frames;
  frames.reserve(arrivals.size());
  for (const Arrival& arrival : arrivals) frames.push_back(arrival.frame);
  return frames;
}

TEST_P(EveryGatherer, FindsAllSetsOfACleanStream) {
  const auto gatherer = make(short_setup(5));
  CollectedSets out;
  push_pulses(*gatherer, 5, 0, 100, out);
  EXPECT_GE(out.pure(), 98) << "one may wait for its proof, one may come out in parts";
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
  EXPECT_EQ(gatherer->discarded(), 0U);
}

TEST_P(EveryGatherer, UsesEachFrameOnceInOrderAndBoundsItsMemory) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const std::string context = GetParam() + ", seed " + std::to_string(seed);
    const GatheringSetup setup = short_setup(1 + seed % 7, 1 + seed % 12);
    const auto gatherer = make(setup);
    CollectedSets out;
    const auto frames = noisy_frames(setup.sources, 100, seed % 5 * 1.5, 0.05 * (seed % 4), seed);
    for (const GatherFrame& frame : frames) gatherer->push(frame, out);
    expect_sound(out, *gatherer, setup, frames.size(), context);
    expect_in_order(out, context);
  }
}

TEST_P(EveryGatherer, EqualStampsAreSoundAndEndless) {
  const GatheringSetup setup = short_setup(3);
  const auto gatherer = make(setup);
  CollectedSets out;
  for (std::int64_t i = 0; i < 300; ++i) {
    GatherFrame frame = frame_at(static_cast<std::uint32_t>(i % 3), 5, 7);
    frame.sensor = DeviceTime(Microseconds(i));
    gatherer->push(frame, out);
  }
  expect_sound(out, *gatherer, setup, 300, GetParam());
}

TEST_P(EveryGatherer, RandomStampsIncludingTheFurthestAreSound) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    boost::random::mt19937_64 random(seed);
    const GatheringSetup setup = short_setup(1 + seed % 4, 1 + seed % 6);
    const auto gatherer = make(setup);
    CollectedSets out;
    for (std::int64_t i = 0; i < 500; ++i) {
      const auto source = static_cast<std::uint32_t>(random() % setup.sources);
      const std::uint64_t bits = random();
      const auto stamp = static_cast<std::int64_t>(seed % 2 == 0 ? bits : bits % 200'000'000);
      gatherer->push({.source = source,
                      .stamp = GlobalTime(Nanoseconds(stamp)),
                      .sensor = DeviceTime(Microseconds(i)),
                      .tag = static_cast<std::int64_t>(bits % 16) - 1},
                     out);
    }
    expect_sound(out, *gatherer, setup, 500, GetParam() + ", seed " + std::to_string(seed));
  }
}

TEST_P(EveryGatherer, DecreasingStampsAreSound) {
  const GatheringSetup setup = short_setup(3);
  const auto gatherer = make(setup);
  CollectedSets out;
  for (std::int64_t i = 0; i < 300; ++i) {
    GatherFrame frame =
        frame_at(static_cast<std::uint32_t>(i % 3), -7.0 * static_cast<double>(i), 300 - i);
    frame.sensor = DeviceTime(Microseconds(i));
    gatherer->push(frame, out);
  }
  expect_sound(out, *gatherer, setup, 300, GetParam());
}

TEST_P(EveryGatherer, OneSourceIsASetPerFrame) {
  const auto gatherer = make(short_setup(1));
  CollectedSets out;
  push_pulses(*gatherer, 1, 0, 50, out);
  EXPECT_EQ(out.sets.size(), 50U);
  EXPECT_EQ(gatherer->discarded(), 0U);
}

TEST_P(EveryGatherer, ASilentSourceCostsItsSetsButNoMemory) {
  const GatheringSetup setup = short_setup(3, 8);
  const auto gatherer = make(setup);
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 200; ++pulse) {
    for (std::uint32_t source = 0; source < 2; ++source) {
      gatherer->push(pulse_frame(source, pulse), out);
    }
  }
  EXPECT_TRUE(out.sets.empty());
  std::uint64_t in_parts = 0;
  for (const auto& set : out.partial) in_parts += set.size();
  EXPECT_GE(gatherer->discarded() + in_parts, 400U - 2 * 8);
}

TEST_P(EveryGatherer, GoesOnAfterASourceWasSilent) {
  const auto gatherer = make(short_setup(3));
  CollectedSets out;
  push_pulses(*gatherer, 3, 0, 30, out);
  for (std::int64_t pulse = 30; pulse < 130; ++pulse) {
    for (std::uint32_t source = 0; source < 2; ++source) {
      gatherer->push(pulse_frame(source, pulse), out);
    }
  }
  const std::int64_t before = out.pure();
  push_pulses(*gatherer, 3, 130, 100, out);
  EXPECT_GE(out.pure() - before, 97);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
}

TEST_P(EveryGatherer, GoesOnAfterAGapOfHours) {
  constexpr std::int64_t kFiveHours = 5 * 3600 * 50;
  const auto gatherer = make(short_setup(4));
  CollectedSets out;
  push_pulses(*gatherer, 4, 0, 30, out);
  const std::int64_t before = out.pure();
  read_clocks(*gatherer, 4, kFiveHours);
  push_pulses(*gatherer, 4, kFiveHours, 100, out);
  EXPECT_GE(out.pure() - before, 98);
}

// Nobody sets a camera's clock back: a gatherer that goes by it sees it go on.
TEST_P(EveryGatherer, GoesOnAfterTheClockWasSetBack) {
  constexpr std::int64_t kFar = 1'000'000;
  const auto gatherer = make(short_setup(4));
  CollectedSets out;
  read_clocks(*gatherer, 4, kFar);
  push_pulses(*gatherer, 4, kFar, 30, out);
  const std::int64_t before = out.pure();
  for (std::int64_t pulse = 0; pulse < 100; ++pulse) {
    for (std::uint32_t source = 0; source < 4; ++source) {
      GatherFrame frame = pulse_frame(source, pulse);
      if (gatherer->wants_evidence()) frame.sensor = pulse_frame(source, kFar + 30 + pulse).sensor;
      gatherer->push(frame, out);
    }
  }
  EXPECT_GE(out.pure() - before, 97);
}

TEST_P(EveryGatherer, AFrameOfTheFarFutureIsSurvived) {
  const auto gatherer = make(short_setup(3));
  CollectedSets out;
  push_pulses(*gatherer, 3, 0, 30, out);
  // Its sensor stamp and pulse are right: a step of one host's clock does not touch these.
  GatherFrame wild = pulse_frame(1, 30);
  wild.stamp += std::chrono::hours(3);
  gatherer->push(pulse_frame(0, 30), out);
  gatherer->push(wild, out);
  gatherer->push(pulse_frame(2, 30), out);
  push_pulses(*gatherer, 3, 31, 100, out);
  // Until its own queue overflows it may be waited for.
  EXPECT_GE(out.pure(), 30 + 100 - 20);
}

// Notes when each set came, in whatever blocks frames are pushed.
class TimedSets final : public TimedSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override { note(set, true); }
  void on_partial_set(std::span<const GatherFrame> set) override { note(set, false); }

  std::vector<std::int64_t> notes;

 private:
  void note(std::span<const GatherFrame> set, bool complete) {
    notes.push_back(complete ? -1 : -2);
    notes.push_back(nanoseconds_of(now()));
    for (const GatherFrame& frame : set) notes.push_back(frame.source);
    for (const GatherFrame& frame : set) notes.push_back(nanoseconds_of(frame.stamp));
  }
};

TEST_P(EveryGatherer, BlocksGiveTheSameSetsAtTheSameTimes) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const GatheringSetup setup = short_setup(1 + seed % 7, 1 + seed % 12);
    auto frames = noisy_frames(setup.sources, 100, seed % 5 * 1.5, 0.05 * (seed % 4), seed);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i].arrival = GlobalTime(Microseconds(static_cast<std::int64_t>(i)));
    }
    TimedSets one_by_one;
    const auto single = make(setup);
    for (const GatherFrame& frame : frames) {
      one_by_one.advance_to(frame.arrival);
      single->push(frame, one_by_one);
    }
    TimedSets in_blocks;
    const auto blocked = make(setup);
    boost::random::mt19937 random(seed);
    for (std::size_t begin = 0; begin < frames.size();) {
      const std::size_t size = std::min<std::size_t>(random() % 30, frames.size() - begin);
      blocked->push_all(std::span(frames).subspan(begin, size), in_blocks);
      begin += size;
    }
    ASSERT_EQ(in_blocks.notes, one_by_one.notes) << "seed " << seed;
    ASSERT_EQ(blocked->discarded(), single->discarded()) << "seed " << seed;
  }
}

TEST_P(EveryGatherer, ASourceThatDoesNotExistIsAProgrammingError) {
  const auto gatherer = make(short_setup(2));
  CollectedSets out;
  EXPECT_DEATH(gatherer->push(frame_at(2, 0, 0), out), "does not exist");
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryGatherer, testing::ValuesIn(gatherer_names()),
                         [](const auto& entry) { return entry.param; });

}  // namespace
}  // namespace simbench
