#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "evaluation/answer/answer.h"
#include "recording/counted.h"
#include "reports/results/results_answer.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::RankedBy;
using evaluation::Results;
using evaluation::Row;
using evaluation::RowStanding;

constexpr double kGoalsMs[] = {1, 0.1, 0.01};

std::vector<const Row*> rows_without_cable(const Results& results) {
  std::vector<const Row*> rows;
  for (const Row& row : results.rows) {
    const bool is_ranked =
        evaluation::standing_of(row, RankedBy::kExposureSpread).is == RowStanding::kRanked;
    if (is_ranked && !std::isnan(row.exposure_spread_p95_ms.median)) rows.push_back(&row);
  }
  return rows;
}

}  // namespace

std::string cables_text(const Results& results) {
  const std::vector<const Row*> rows = rows_without_cable(results);
  std::vector<std::string> without;
  std::vector<std::string> with;
  std::vector<std::string> counts;
  for (const double goal_ms : kGoalsMs) {
    std::size_t reached = 0;
    for (const Row* row : rows) {
      if (row->exposure_spread_p95_ms.p95 < goal_ms) ++reached;
    }
    (reached > 0 ? without : with).push_back(fmt::format("{} ms", goal_ms));
    counts.push_back(fmt::format("{} reach {} ms", reached, goal_ms));
  }
  std::string text;
  if (without.empty()) {
    text = fmt::format("A trigger cable is needed for {}", fmt::join(with, ", "));
  } else {
    text = fmt::format("No trigger cable is needed for {}", fmt::join(without, " or "));
    if (!with.empty()) text += fmt::format(", but for {} one is", fmt::join(with, " and "));
  }
  return fmt::format("{}: of {} without one, {} in 95 % of the pulses and worlds.", text,
                     counted(rows.size(), "pipeline"), fmt::join(counts, ", "));
}

std::string cable_sentence(const Results& results) {
  for (const Row& row : results.rows) {
    if (!row.capture_alignment.empty() || std::isnan(row.exposure_spread_p95_ms.median)) continue;
    return fmt::format("With the cable, {} has {}.", row.pipeline,
                       time_text(row.exposure_spread_p95_ms.median));
  }
  return "";
}

}  // namespace simbench::reports
