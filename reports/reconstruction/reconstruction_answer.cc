
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/ports/stage.h"
#include "evaluation/answer/answer.h"
#include "evaluation/statistics/paired.h"
#include "reports/reconstruction/reconstruction_document.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::RowStanding;
using reconstruction::ReconstructionResults;
using reconstruction::ReprojectionRow;
using reconstruction::SeedReprojection;

bool can_run(const ReprojectionRow& row) {
  evaluation::Row choice;
  copy_stages(row, choice);
  return evaluation::standing_of_stages(choice, evaluation::RankedBy::kAmd) == RowStanding::kRanked;
}

// Returns the rows that a rig can run and that have an error, the smallest first.
std::vector<const ReprojectionRow*> by_error(const std::vector<ReprojectionRow>& rows) {
  std::vector<const ReprojectionRow*> sorted;
  for (const ReprojectionRow& row : rows) {
    if (can_run(row) && !std::isnan(row.mean_cm().median)) sorted.push_back(&row);
  }
  std::ranges::stable_sort(sorted, {},
                           [](const ReprojectionRow* row) { return row->mean_cm().median; });
  return sorted;
}

// The row's errors at the seeds of `as`, in their order; NaN for one that the row does not have.
std::vector<double> errors_by_seed(const ReprojectionRow& row, const ReprojectionRow& as) {
  std::vector<double> values;
  values.reserve(as.seeds.size());
  for (const SeedReprojection& seed : as.seeds) {
    const auto found = std::ranges::find(row.seeds, seed.seed, &SeedReprojection::seed);
    values.push_back(found == row.seeds.end() ? reconstruction::kNoError : found->errors.mean_cm);
  }
  return values;
}

std::string others_text(const std::vector<const ReprojectionRow*>& sorted) {
  const ReprojectionRow& best = *sorted.front();
  std::vector<evaluation::ComparisonTask> tasks;
  tasks.reserve(sorted.size());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    tasks.push_back(
        {evaluation::pair_up(errors_by_seed(best, best), errors_by_seed(*sorted[i], best)), {}});
  }
  const std::vector<evaluation::PairedComparison> compared = evaluation::compare_together(tasks);
  std::vector<std::string> equals;
  std::vector<std::string> worse;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const std::string& name = sorted[i + 1]->pipeline;
    if (compared[i].verdict != evaluation::Verdict::kWorse) {
      equals.push_back(name);
    } else {
      worse.push_back(
          fmt::format("{} has {} times as much", name, number_text(compared[i].ratio.value)));
    }
  }
  std::vector<std::string> sentences;
  if (!equals.empty()) {
    sentences.push_back(
        fmt::format("These seeds cannot tell {} from it.", fmt::join(equals, ", ")));
  }
  if (!worse.empty()) sentences.push_back(fmt::format("{}.", fmt::join(worse, "; ")));
  return fmt::format("{}", fmt::join(sentences, " "));
}

// The text is about the scenario's own speed, or the first.
std::string tolerance_text(const ReconstructionResults& results) {
  const std::vector<SyncLimit> limits = sync_limits(results.curve);
  if (limits.empty()) return "";
  const auto own = std::ranges::find(limits, 1.0, &SyncLimit::speed_factor);
  const SyncLimit& limit = own == limits.end() ? limits.front() : *own;
  if (std::isnan(limit.floor_cm)) return "";
  return fmt::format(
      "At {} hosts may be {} ms apart until the error is {:.0f} % above its floor of {} cm, which "
      "is calibration and depth noise.",
      speed_text(limit.speed_m_per_s, limit.speed_factor), limit_text(limit),
      100 * kToleratedGrowth, cm_text(limit.floor_cm));
}

std::string certainty_text(const ReprojectionRow& best) {
  const std::vector<double> values = errors_by_seed(best, best);
  const std::size_t seeds = evaluation::count_of_existing(values);
  if (seeds < kFewestSeeds) {
    return fmt::format("{}.", few_seeds_text(seeds));
  }
  const double relative =
      evaluation::median_interval(values, static_cast<std::int64_t>(seeds)).relative;
  if (std::isnan(relative)) return "";
  return fmt::format("The median of {} is known to {:.0f} %.", counted(seeds, "seed"),
                     std::ceil(100 * relative));
}

}  // namespace

AnswerText reconstruction_answer(const ReconstructionResults& results) {
  const std::vector<const ReprojectionRow*> sorted = by_error(results.rows);
  if (sorted.empty()) return {.lead = "No pipeline that a rig can run was reconstructed."};
  const ReprojectionRow& best = *sorted.front();
  AnswerText answer{
      .lead = fmt::format("{} gives the best reconstruction of the {} that a rig can run: mean "
                          "error {} cm, its exposures {} ms apart.",
                          best.pipeline, sorted.size(), cm_text(best.mean_cm()),
                          desync_text(best.desync_ms().median))};
  answer.add("Others", others_text(sorted));
  answer.add("Tolerance", tolerance_text(results));
  answer.add("Uncertain", certainty_text(best));
  return answer;
}

}  // namespace simbench::reports
