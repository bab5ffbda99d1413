#include "evaluation/scoring/ranked_by.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
namespace {

struct RankingEntry {
  RankedBy ranked_by = RankedBy::kAmd;
  const char* metric = "";
  ResultKind kind = ResultKind::kCaptures;
};

constexpr RankingEntry kRankings[] = {
    {RankedBy::kAmd, "amd_ms"},
    {RankedBy::kRmdv, "rmdv_ms"},
    {RankedBy::kAbsoluteError, "absolute_error_ms"},
    {RankedBy::kHostError, "host_error_ms"},
    {RankedBy::kExposureSpread, "exposure_spread_p95_ms"},
    {RankedBy::kClockSpread, "clock_spread_ms", ResultKind::kClockRuns}};

}  // namespace

RankedBy ranked_by(scenarios::TableKind table) {
  return table == scenarios::TableKind::kAlignment ? RankedBy::kExposureSpread : RankedBy::kAmd;
}

std::optional<RankedBy> ranked_by_named(std::string_view metric_id) {
  for (const RankingEntry& entry : kRankings) {
    if (metric_id == entry.metric && entry.kind == ResultKind::kCaptures) {
      return entry.ranked_by;
    }
  }
  return std::nullopt;
}

std::vector<std::string> ranking_metrics() {
  std::vector<std::string> ids;
  for (const RankingEntry& entry : kRankings) {
    if (entry.kind == ResultKind::kCaptures) ids.emplace_back(entry.metric);
  }
  return ids;
}

const Metric& ranked_metric(RankedBy ranked_by) {
  const auto* const found = std::ranges::find(kRankings, ranked_by, &RankingEntry::ranked_by);
  SIMBENCH_ASSERT(found != std::end(kRankings), "each ranking has its metric");
  return metric(found->metric, found->kind);
}

const Series& ranked_series(const Row& row, RankedBy ranked_by) {
  return ranked_metric(ranked_by).series(row);
}

RankedBy ranking_of(const Results& results) {
  if (results.ranked_by != RankedBy::kAmd) return results.ranked_by;
  const bool has_amd = std::ranges::any_of(
      results.rows, [](const Row& row) { return !std::isnan(row.amd_ms.median); });
  return has_amd ? RankedBy::kAmd : RankedBy::kAbsoluteError;
}

}  // namespace simbench::evaluation
