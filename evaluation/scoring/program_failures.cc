#include "evaluation/scoring/program_failures.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "evaluation/scoring/metrics.h"
#include "recording/counted.h"
#include "recording/program_failure.h"

namespace simbench::evaluation {
namespace {

std::size_t failed_seeds(const Row& row) {
  std::set<std::uint64_t> seeds;
  for (const SeedProgramFailure& each : row.program_failures) seeds.insert(each.seed);
  return seeds.size();
}

// Every series has a value of each seed.
std::size_t seeds_of(const Row& row) {
  return std::max(row.seeds.size(),
                  std::max(row.amd_ms.values.size(), row.clock_spread_ms.values.size()));
}

}  // namespace

void void_score(SeedScore& score) {
  if (score.program_failures.empty()) return;
  static_cast<MetricValues<double>&>(score) = {};
  score.emission_latency_max_ms = kNan;
  score.frames = {};
  score.sets = {};
  score.genlock_index_errors = 0;
  score.pulses.clear();
  std::ranges::fill(score.host_errors_ms, kNan);
  score.sessions.clear();
}

std::string program_failure_text(const Row& row) {
  if (row.program_failures.empty()) return "";
  const SeedProgramFailure& first = row.program_failures.front();
  return fmt::format("a program ended in {} of {}: seed {}, {}", failed_seeds(row),
                     counted(seeds_of(row), "seed"), first.seed, failure_text(first.failure));
}

bool failed_in_all_seeds(const Row& row) {
  return row.is_of_programs && std::ranges::none_of(row.seeds, [](const SeedScore& seed) {
           return seed.recorded && seed.program_failures.empty();
         });
}

}  // namespace simbench::evaluation
