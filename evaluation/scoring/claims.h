// The claims of Yoon et al. 2021 as statements about one seed, and the fraction of seeds in which
// each holds.
//
// The paper has one recording per cell, so each claim rests on one draw. A simulated capture is
// such a draw; the fraction of seeds shows how robust the claim is. Thresholds are this project's
// where the paper gives none, and part of each claim's text. Pipelines are paired by seed.
// Source: docs/reference/paper.md section 11.
#pragma once

#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// Returns the claims in order, C1 first. `rows` are of one scenario, all with the same seeds in the
// same order. A claim about missing or unverified pipelines, another trigger rate or two scenarios
// has no fraction, but states what it needs. Seeds that lack a quantity of the claim are left out.
std::vector<Claim> check_claims(const std::vector<Row>& rows, double trigger_rate_hz);

// The rows of one scenario, as above; they outlive this.
struct ClaimedRun {
  const std::vector<Row>& rows;
  double trigger_rate_hz = 0;
};

// Returns the claims across scenarios: C4, and C2 and C3 in the same seed. The runs have the same
// seeds, by which they are paired.
std::vector<Claim> check_claims_across(const ClaimedRun& at_15_fps, const ClaimedRun& at_45_fps);

// Returns the same claims of the one draw that is printed (Row::published): a fraction of 0 or 1,
// or none where a claim needs what no table has.
std::vector<Claim> check_printed_claims(const ClaimedRun& run);
std::vector<Claim> check_printed_claims_across(const ClaimedRun& at_15_fps,
                                               const ClaimedRun& at_45_fps);

// The percentage of the deciding seeds in which a claim holds, with its 95 % binomial interval; NaN
// without a fraction.
Percentile held_percent(const Claim& claim);

// Returns whether a claim needs SeedScore::offline_amd_ms of this pipeline.
bool needs_offline_amd(std::string_view pipeline);

}  // namespace simbench::evaluation
