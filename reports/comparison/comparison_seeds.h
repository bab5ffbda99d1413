// Which seeds of two results stand in pairs.
//
//   const SeedPairing pairing = pair_seeds(a.results, b.results);
//   pair_up(pairing.of_a(row_a.amd_ms.values), pairing.of_b(row_b.amd_ms.values));
#ifndef SIMBENCH_REPORTS_COMPARISON_COMPARISON_SEEDS_H_
#define SIMBENCH_REPORTS_COMPARISON_COMPARISON_SEEDS_H_

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

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

struct SeedPairing {
  std::uint64_t skip_a = 0;  // values before the first that has a partner
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

// The seeds that both have.
SeedPairing pair_by_seed(const SeedRange& a, const SeedRange& b);
// The n-th with the n-th.
SeedPairing pair_by_index(const SeedRange& a, const SeedRange& b);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_COMPARISON_SEEDS_H_
