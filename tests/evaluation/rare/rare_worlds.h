// Runs whose rare events have known probabilities: independent streams of the simulator's random
// numbers, under its seed fields (sim/engine/seed_field.h), as a simulated world has them.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "evaluation/rare/splitting.h"
#include "sim/engine/random.h"
#include "sim/engine/seed_field.h"

namespace simbench::evaluation {

// Calls `level` with the run's seed, the field being active; an event is a level above the bound.
inline RareFunction world_of(double bound, std::function<double(std::uint64_t seed)> level) {
  return [bound, level = std::move(level)](const RareRun& run) {
    sim::SeedField field;
    for (const RareChange& change : run.changes) {
      field.add({.key = change.key, .share = change.share, .step = change.step});
    }
    const sim::SeedFieldScope scope(field);
    const double reached = level(run.seed);
    return RareScore{.level = reached, .share = reached > bound ? 1.0 : 0.0};
  };
}

// The sum of so many normal numbers, scaled to variance 1.
inline double normal_sum(std::uint64_t seed, std::size_t numbers) {
  double sum = 0;
  for (std::size_t i = 0; i < numbers; ++i) {
    sum += sim::RandomStream(seed, "normal", i).normal(1);
  }
  return sum / std::sqrt(static_cast<double>(numbers));
}
inline double normal_tail(double x) { return std::erfc(x / std::numbers::sqrt2) / 2; }

// The largest of so many exponential numbers of mean 1, by inversion.
inline double largest_exponential(std::uint64_t seed, std::size_t numbers) {
  double largest = 0;
  for (std::size_t i = 0; i < numbers; ++i) {
    largest = std::max(largest, -std::log1p(-sim::RandomStream(seed, "exponential", i).uniform()));
  }
  return largest;
}
inline double largest_tail(double x, std::size_t numbers) {
  return -std::expm1(static_cast<double>(numbers) * std::log1p(-std::exp(-x)));
}

}  // namespace simbench::evaluation
