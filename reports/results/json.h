// results.json: the results for programs.
//
// schema_version 1; within a version members are only added. A value that does not exist (0/0, no
// truth, no recording of that seed) is null. The text is a function of the results alone: equal
// results give equal bytes, with every compiler and any number of threads; only /performance
// differs between runs.
//
//   {"schema_version": 1, "version": ..., "commit": ..., "scenario": ...,
//    "based_on", "changed", "published_left_out": see state_derivation(),
//    "own_load_of_pipelines": true, only if the scenario draws the load of hosts and network for
//    each
//      pipeline: in that part rows of one seed are not of one world,
//    "seeds": {"first": 1, "count": 32},
//    "ranked_by": the metric that ranks the rows (evaluation/scoring/ranked_by.h), "amd_ms",
//    "rows": [{"pipeline": ..., "host_sync": ..., "device_time": ..., "gathering": ...,
//              "capture_alignment": what steers the exposures, only if something does,
//              "offline": whether device_time needs the whole recording,
//              each metric under the id and in the object of evaluation/scoring/metrics.h,
//              {"median", "p05", "p95", "values": [in seed order]}, a number or a count: "amd_ms",
//              ..., "gathering_score": {"precision", ...}, "frames": {"expected", ...}, ...,
//              "scored_seeds": over how many seeds AMD's median is; a metric has null in its values
//                where a seed has none,
//              "ground_truth": "simulation", "genlock_order" or "none", "verified": whether it is
//                known which frames belong together (else "evaluated_pulses" counts sets; what
//                needs pulses is null), "notes": [failures, "repetition 3: ..."],
//              "standing": "ranked", "failed", "limit" or "reference"
//              (evaluation/answer/standing.h), "failed": null, or why, "program_failures": see
//              state_programs(), "published": null or
//              {"amd_ms", "rmdv_ms", "amd_inside", "rmdv_inside" (null: too
//                few seeds to tell),
//                "rmdv_attainable", "amd_percentile", "amd_percentile_interval": [low, high],
//                rmdv_percentile likewise}}],
//    "answer": reports/results/answer_fields.h,
//    "claims": [{"id", "holds_fraction", "text", "needs", "decided_seeds"}],
//    "asymmetry_floor": null or {"sigma_ms", "host_error_ms", "amd_ms"}
//      (evaluation/scoring/asymmetry_floor.h), "warnings": [...],
//    "loss_reasons": [what makes pulses be lost in this world],
//    "load_reality": [how far the bench was off beside real rigs under such load],
//    "performance": {"events", "events_per_second", "simulated_seconds_per_second", ...}}
#pragma once

#include <span>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/results/results_answer.h"
#include "reports/text/json_node.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

// The schema of manifest.json and results.json: the written one, and the newest that can be read.
inline constexpr int kArchiveSchemaVersion = 1;
inline constexpr const char* kRankedByMember = "ranked_by";
inline constexpr const char* kLossReasonsMember = "loss_reasons";
inline constexpr const char* kLoadRealityMember = "load_reality";  // of clock runs too
inline constexpr const char* kOwnLoadMember = "own_load_of_pipelines";

// Whether a value at this percentile is inside; null with too few seeds to tell.
Json inside_json(const evaluation::Percentile& percentile);

Json performance_json(const evaluation::Performance& cost);

// Indented by two, ends with a line feed. The answer is that of the results, without levers if none
// is given.
std::string json(const evaluation::Results& results);
std::string json(const evaluation::Results& results, const ResultsAnswer& answer);

// What a scenario rests on (scenarios/derivation.h), in any document for programs: members beside
// "scenario", only of a scenario that rests on another or is changed:
//
//   "based_on": the name of the built-in scenario, or of the own file,
//   "changed": [{"pointer": "/trigger/rate_hz", "from": 45, "to": 30}], null: not there,
//   "published_left_out": the scenario whose published values do not hold here, or null
void state_derivation(const scenarios::Derivation& derivation, Json& root);
// Throws scenarios::InputError. A document without the members has none.
scenarios::Derivation read_derivation(const JsonNode& root);

// Rows of real programs, in clock runs too, have the member "program_failures": a list, empty if
// none ended too early, of {"seed", "host", "program", "at_s": since the run began, "how",
// "last_words": null or the last line of its output, "log": null or the file that has it}. A seed
// in it has null in all values.
void state_programs(const evaluation::Row& row, Json& to);
// Throws scenarios::InputError. Other rows lack the member.
void read_programs(const JsonNode& from, evaluation::Row& row);

// Published figures and their comparison: an array "published_figures", which results without
// figures lack. An entry has what the scenario states, the percentile of the number among the
// seeds, of a bound the percentage of the seeds that keep it, each with its interval, and the
// verdict: "inside", "outside", "holds", "fails" or null (too few seeds).
void state_published_figures(const evaluation::Results& results, Json& root);
// Takes what was published and compares it anew with the rows, as medians are computed anew. Throws
// scenarios::InputError for a pipeline without a row, a metric that there is not or that is no
// series, and for several numbers or none.
std::vector<evaluation::FigureComparison> read_published_figures(
    const JsonNode& root, std::span<const evaluation::Row> rows);

}  // namespace simbench::reports
