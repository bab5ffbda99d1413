#include "reports/comparison/comparison_seeds.h"

#include <fmt/format.h>

namespace simbench::reports {

std::string seeds_text(const SeedRange& seeds) {
  if (seeds.count == 1) return fmt::format("{}", seeds.first);
  return fmt::format("{}-{}", seeds.first, seeds.first + seeds.count - 1);
}

SeedPairing pair_by_seed(const SeedRange& a, const SeedRange& b) {
  const std::uint64_t first = std::max(a.first, b.first);
  const std::uint64_t end = std::min(a.first + a.count, b.first + b.count);
  if (end <= first) return {};
  return {.skip_a = first - a.first, .skip_b = first - b.first, .count = end - first};
}

SeedPairing pair_by_index(const SeedRange& a, const SeedRange& b) {
  return {.skip_a = 0, .skip_b = 0, .count = std::min(a.count, b.count)};
}

}  // namespace simbench::reports
