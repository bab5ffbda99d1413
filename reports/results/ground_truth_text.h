// The words of reports about the ground truth of a score and about failures in its recording.
//
// Results of simulations alone have none.
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// For programs: "simulation", "genlock_order" or "none".
const char* ground_truth_name(evaluation::GroundTruth truth);

// Whether the row was scored without knowing which frames belong together.
bool is_unverified(const evaluation::Row& row);

// For people: "simulation", "GenLock order", "unverified"; "-" for a row without any recording.
std::string ground_truth_label(const evaluation::Row& row);

// Whether a row is not of a simulation and needs such a label.
bool has_real_rows(const evaluation::Results& results);

// The exception where Scenario::draws_load(): rows of one seed share their world but for this.
// Means, intervals and tests over paired seeds hold all the same: the differences are independent
// from seed to seed, and the loads of both rows have one law.
inline constexpr const char* kOwnLoad =
    "the load of hosts and network is drawn for each pipeline on its own, so that in this part two "
    "rows differ in distribution and not seed by seed";

// What rows of one seed share: "Every pipeline meets the same worlds, one per seed.", with kOwnLoad
// if the scenario draws loads; on a rig "Every repetition of a pipeline is a capture of its own."
std::string shared_worlds(const evaluation::Results& results);

// The meaning of "unverified"; empty if no row is.
std::string unverified_legend(const evaluation::Results& results);

// The notes of all rows, a line each: "PIPELINE, repetition 3: ...".
std::vector<std::string> note_lines(const evaluation::Results& results);

}  // namespace simbench::reports
