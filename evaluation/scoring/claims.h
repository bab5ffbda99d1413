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

namespace simbench::evaluation {

// Returns C1 ... C10, in order. `rows` are of one scenario, all with the same seeds in the same
// order. A claim about missing or unverified pipelines, another trigger rate or two scenarios has
// no fraction, but states what it needs. Seeds that lack a quantity of the claim are left out.
std::vector<Claim> check_claims(const std::vector<Row>& rows, double trigger_rate_hz);

// Returns whether a claim needs SeedScore::offline_amd_ms of this pipeline.
bool needs_offline_amd(std::string_view pipeline);

}  // namespace simbench::evaluation
