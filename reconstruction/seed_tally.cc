#include "reconstruction/seed_tally.h"

namespace simbench::reconstruction {

void SeedTally::add(const evaluation::ExposureSet& set, bool reconstructed,
                    const ErrorStatistics& errors) {
  ++(reconstructed ? counts_.sets : counts_.failed_sets);
  for (const auto& exposure : set.cameras) counts_.missing_frames += exposure ? 0 : 1;
  spread_ms_ += set.spread_ms();
  errors_.merge(errors);
}

SeedReprojection SeedTally::finish(std::uint64_t seed, bool gathered) const {
  SeedReprojection result = counts_;
  result.seed = seed;
  result.errors = errors_.summary();
  result.gathered = gathered;
  if (const std::int64_t all = result.sets + result.failed_sets; all > 0) {
    result.desync_ms = spread_ms_ / static_cast<double>(all);
  }
  return result;
}

}  // namespace simbench::reconstruction
