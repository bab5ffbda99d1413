// The claims of Yoon et al. 2021 as statements about one seed, and in how many seeds they hold.
//
// The paper has one recording per cell, so each of its claims rests on one draw; a simulated
// capture is such a draw, and the fraction of seeds says how robust the claim is. Thresholds where
// the paper gives none are ours; the text of each claim states them. Pipelines are paired by seed.
// Source: docs/reference/paper.md section 11.
#ifndef SIMBENCH_EVALUATION_SCORING_CLAIMS_H_
#define SIMBENCH_EVALUATION_SCORING_CLAIMS_H_

#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// C1 ... C10, in order. `rows` are of one scenario, all with the same seeds in the same order. A
// claim about pipelines that are not among the rows or not verified, about another trigger rate or
// about two scenarios has no fraction but says what it needs. Seeds in which a quantity of the
// claim does not exist are left out.
std::vector<Claim> check_claims(const std::vector<Row>& rows, double trigger_rate_hz);

// Whether a claim needs SeedScore::offline_amd_ms of this pipeline.
bool needs_offline_amd(std::string_view pipeline);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_CLAIMS_H_
