// Advice for a buyer (evaluation/advice) as text, Markdown or JSON: first a sentence that answers,
// then the rigs from the cheapest on, then what was assumed.
//
// JSON: {"schema_version", "version", "commit", "answer" (reports/text/answer_json.h), "cameras",
// "rate_hz", "requirements": [text], "sets": [{"pointer", "value"}], "seeds", "recommended": a
// place in options or null, "fails_first": {"metric", "stage", "share"} or null, "rare": null or as
// of rare_json(), "options": [{"rig", "hosts", "cameras_per_host", "parts": [name],
// "price_low_eur", "price_high_eur", "settled", "pipelines":
// [{"pipeline", "met", "seeds", "probability", "low", "high", "margin", "frames_dropped",
// "medians": {id: value}}]}]}; the pipelines from the best on.
#pragma once

#include <string>
#include <vector>

#include "evaluation/advice/advice.h"
#include "evaluation/rare/splitting.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

AnswerText advice_answer(const evaluation::Advice& advice);

Document advice_document(const evaluation::Advice& advice);
// To which file_text() may be applied.
Json advice_json(const evaluation::Advice& advice);

// "EUR" with a number for the size of a price: "low (60-180 EUR)".
std::string price_class(const scenarios::PriceRange& price);

// How often a recommended rig goes wrong (app/rare_sets.h, evaluation/rare) as a block and as JSON:
// [{"event", "bound_ms", "probability", "low", "high", "per_day", "per_day_low", "per_day_high",
// "is_below", "runs", "repeats"}]; what does not exist is null.
struct RareResult {
  std::string event;  // "spread above 0.1 ms"
  double bound_ms = 0;
  double sets_per_day = 0;
  evaluation::RareEstimate estimate{};
};

// The heading names rig and pipeline.
Block rare_block(const std::string& heading, const std::vector<RareResult>& results);
Json rare_json(const std::vector<RareResult>& results);

}  // namespace simbench::reports
