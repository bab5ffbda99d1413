// Which results can be compared: those of the same world, with seeds in pairs.
//
// The world is the input of a pipeline: everything except the parameters of the algorithms, the
// pipelines, published values and the scenario's description of itself. Numbers of different worlds
// do not compare the algorithms. Algorithms may differ, since comparisons are about them.
//
//   const ScenarioDifferences d = compare_scenarios(a.scenario_json, b.scenario_json);
//   if (!d.world.empty()) refuse(d.world);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// "/network/latency_fixed_ms: 0.1 against 0.2", in alphabetical order. Pipelines stand by name:
// "/pipelines/oracle/device_time"; a pipeline of one scenario alone is no difference.
struct ScenarioDifferences {
  std::vector<std::string> world;
  std::vector<std::string> algorithms;
};

// `a`, `b`: two resolved scenarios. Throws scenarios::InputError if one is not JSON.
ScenarioDifferences compare_scenarios(const std::string& a, const std::string& b);

// Returns a UUID of version 5 (SHA-1) of a JSON text: equal for equal content, whatever the spacing
// and the order of members.
std::string digest_of_json(const std::string& text);

// Joins the first few in one line: "x; y; and 7 more".
std::string first_few(const std::vector<std::string>& differences);

// `count` consecutive seeds.
struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t count = 0;
};

inline SeedRange seeds_of(const evaluation::Results& results) {
  return {results.first_seed, results.seed_count};
}

// "1-32"; "7".
std::string seeds_text(const SeedRange& seeds);

// The pairs of seeds of two results.
//
//   const SeedPairing pairing = pair_by_seed(seeds_of(a.results), seeds_of(b.results));
//   evaluation::pair_up(pairing.of_a(row_a.amd_ms.values), pairing.of_b(row_b.amd_ms.values));
struct SeedPairing {
  std::uint64_t skip_a = 0;  // values before the first pair
  std::uint64_t skip_b = 0;
  std::uint64_t count = 0;

  std::vector<double> of_a(const std::vector<double>& values) const { return part(values, skip_a); }
  std::vector<double> of_b(const std::vector<double>& values) const { return part(values, skip_b); }

 private:
  std::vector<double> part(const std::vector<double>& values, std::uint64_t skip) const {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(skip);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
  }
};

// Pairs the seeds that both have.
SeedPairing pair_by_seed(const SeedRange& a, const SeedRange& b);
// Pairs the n-th with the n-th.
SeedPairing pair_by_index(const SeedRange& a, const SeedRange& b);

}  // namespace simbench::reports
