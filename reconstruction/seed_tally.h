// Adds up the frame sets of one pipeline at one seed.
//
//   SeedTally tally;
//   tally.add(set, reconstructed, errors_of_the_set);   // each set
//   row.seeds.push_back(tally.finish(seed, gathered));
#ifndef SIMBENCH_RECONSTRUCTION_SEED_TALLY_H_
#define SIMBENCH_RECONSTRUCTION_SEED_TALLY_H_

#include <cstdint>

#include "evaluation/run/exposure_sets.h"
#include "reconstruction/error_statistics.h"
#include "reconstruction/results.h"

namespace simbench::reconstruction {

class SeedTally {
 public:
  void add(const evaluation::ExposureSet& set, bool reconstructed, const ErrorStatistics& errors);
  SeedReprojection finish(std::uint64_t seed, bool gathered) const;

 private:
  ErrorStatistics errors_;
  SeedReprojection counts_;
  double spread_ms_ = 0;
};

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_SEED_TALLY_H_
