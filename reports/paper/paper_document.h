// The paper's experiment at both rates beside what is printed: Tables 2 and 3, the claims, Table 4
// and the figures, what is a fit, and what is not reached.
//
// Every verdict follows from the seeds at hand: a printed value lies at a percentile of its row's
// seeds, with a 95 % interval, and is inside, outside or cannot be placed (Placement in
// evaluation/statistics/statistics.h). A claim has the share of the seeds in which it holds, at
// each rate or across both (evaluation/scoring/claims.h), beside what the printed numbers say of
// it. Times are in milliseconds, but for texts, which have the unit that fits.
//
//   PaperResults results = app::run_paper({.seeds = 200}, nullptr);
//   std::cout << plain(paper_document(results));
//
// Source: docs/reference/paper.md sections 9 to 11.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"
#include "reconstruction/results.h"
#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "scenarios/scenario.h"

namespace simbench::reports {

// The runs behind one printed table.
struct PaperRun {
  std::string table;  // "Table 2"
  scenarios::Scenario scenario;
  evaluation::Results results;  // with Row::seeds
};

struct PaperResults {
  PaperRun at_15_fps;
  PaperRun at_45_fps;  // with the same seeds
  std::optional<reconstruction::ReconstructionResults> table_4{};
  std::string no_table_4{};       // then: why there is none
  std::vector<Figure> figures{};  // those that the paper has; empty: they were not drawn
};

// A printed number beside its row.
struct PrintedValue {
  const evaluation::Row* row = nullptr;  // of the run
  std::string metric;                    // "amd_ms" or "rmdv_ms"
  double printed = evaluation::kNan;
  evaluation::Percentile percentile;  // of the printed number among the seeds
  double most = evaluation::kNan;     // of an RMDV: what eq. (4) allows with the printed AMD
  bool is_attainable() const { return !(printed > most); }
};

// In the order of the rows, AMD before RMDV. The run outlives them.
std::vector<PrintedValue> printed_values(const PaperRun& run);

// A claim at each rate and across both.
struct PaperClaim {
  std::string id;
  std::string text;
  std::optional<bool> printed;       // whether the printed numbers keep it; nothing: no table says
  evaluation::Percentile at_15_fps;  // the share of the seeds in which it holds; NaN where it is
  evaluation::Percentile at_45_fps;  // not about that rate
  evaluation::Percentile at_both;    // in the same seed; of claims across the rates
  std::string needs;                 // why no share is known; empty where one is
};
std::vector<PaperClaim> paper_claims(const PaperResults& results);

// How many of the printed AMD values are inside, which are not, and which claims hold.
AnswerText paper_answer(const PaperResults& results);

// The printed values that the seeds do not have, each with the reason as far as it is known.
std::vector<std::string> not_reached(const PaperRun& run);

Document paper_document(const PaperResults& results);

// Returns the page as JSON, for programs:
//
//   {"schema_version": 1, "version", "commit",
//    "runs": [{"table": "Table 2", "rate_hz": 15, "printed": [{"pipeline", "metric", "printed",
//      "median", "percentile", "percentile_interval", "attainable", "inside": null where the seeds
//      are too few}], "not_reached": [...], "results": as in results.json}, ...],
//    "claims": [{"id", "text", "printed": true, false or null, "at_15_fps": null or {"percent",
//      "percent_interval"}, "at_45_fps", "at_both": likewise, "needs": null or a text}],
//    "table_4": null or as `simbench reconstruct --format json` has it, "no_table_4": null or why,
//    "figures": [{"id", "paper", "scenario", "pipeline", "seed", "caption", "absent"}]}
std::string paper_json(const PaperResults& results);

}  // namespace simbench::reports
