// Random streams for the tests of gathering: noisy stamps, lost frames, delays, ties.
#pragma once

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {

struct GatheringWorld {
  std::uint32_t sources = 4;
  std::int64_t pulses = 60;
  double period_ms = 22;
  double sigma_ms = 0;                     // of the stamps
  double drop = 0;                         // share of lost frames
  double outage = 0;                       // share of sources that are silent in the middle third
  double delay_max_ms = 0;                 // of delivery, beyond 8 ms
  double quantum_ms = 0;                   // of the stamps: makes ties
  std::vector<double> offset_ms{};         // of a source's stamps; empty: none
  std::vector<std::int64_t> dies_after{};  // a source's frames; empty: all deliver all of theirs
};

// In order of arrival; the tag is the pulse, `arrival` is filled in. A source's frames stay in
// order, its stamps may not if sigma_ms is large.
inline std::vector<GatherFrame> frames_of(const GatheringWorld& world, std::uint32_t seed) {
  boost::random::mt19937 random(seed);
  boost::random::normal_distribution<double> noise_ms(0, world.sigma_ms);
  boost::random::uniform_01<double> uniform;
  std::vector<GatherFrame> frames;
  for (std::uint32_t source = 0; source < world.sources; ++source) {
    const bool fails = world.outage > 0 && uniform(random) < world.outage;
    double last_ms = 0;
    for (std::int64_t pulse = 0; pulse < world.pulses; ++pulse) {
      const double at_ms = static_cast<double>(pulse) * world.period_ms;
      double stamp_ms = at_ms + noise_ms(random);
      if (world.quantum_ms > 0) {
        stamp_ms = std::floor(stamp_ms / world.quantum_ms) * world.quantum_ms;
      }
      last_ms = std::max(last_ms, at_ms + 8 + world.delay_max_ms * uniform(random));
      if (!world.offset_ms.empty()) stamp_ms += world.offset_ms[source];
      const bool dead = !world.dies_after.empty() && pulse >= world.dies_after[source];
      const bool silent =
          dead || (fails && pulse > world.pulses / 3 && pulse < 2 * world.pulses / 3);
      if (uniform(random) < world.drop || silent) continue;
      frames.push_back(frame_at(source, stamp_ms, pulse));
      frames.back().arrival = GlobalTime(from_ms(last_ms));
    }
  }
  std::ranges::stable_sort(frames, {}, &GatherFrame::arrival);
  return frames;
}

}  // namespace simbench
