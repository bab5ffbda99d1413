// From the table of stamps to the scores of a seed: everything that is a mean over pulses.
//
// Only complete pulses count. A score that does not exist is NaN: all of them without a complete
// pulse, the errors without truth, the spread inside a host where no host has two sources, the
// spread between hosts where there is one host, the trend of a single pulse.
#ifndef SIMBENCH_EVALUATION_SCORING_PULSE_SCORES_H_
#define SIMBENCH_EVALUATION_SCORING_PULSE_SCORES_H_

#include <cstdint>
#include <vector>

#include "algorithms/ports/time.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/pulse_table.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// What the scores need to know besides the table.
struct PulseScoring {
  MedianKind median = MedianKind::kUpperMiddle;
  Nanoseconds period{};  // of the pulses
  std::uint32_t hosts = 0;
  std::vector<std::uint32_t> host_of_source;  // by column of the table
};

// Fills in amd_ms, rmdv_ms, absolute_error_ms, bias_ms, exposure_spread_ms, the two spreads by
// host, trend_ms, share_below_half_period, frames, sets.complete_pulses and pulses.
// O(pulses x sources).
void score_pulses(const PulseTable& table, const PulseScoring& scoring, SeedScore& score);

// AMD alone.
double amd_ms(const PulseTable& table);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_PULSE_SCORES_H_
