#include "reports/results/results_answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "evaluation/run/leaderboard.h"
#include "reports/results/ground_truth_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Answer;
using evaluation::Budget;
using evaluation::kStageCount;
using evaluation::RankedBy;
using evaluation::Results;
using evaluation::Row;
using evaluation::Series;

constexpr std::size_t kNamedEquals = 2;  // of those that cannot be told from the best
constexpr double kSmallShare = 0.05;     // parts of a budget below this have no name
constexpr double kMuchLarger = 3;        // absolute error / AMD that deserves a word
constexpr double kWorthWinning = 0.01;   // of the error
// What each stage would give if it alone were ideal.
constexpr std::array<const char*, kStageCount> kIdeals = {"pulses on time",
                                                          "equal exposures",
                                                          "stamps without noise or steps",
                                                          "perfect camera clocks",
                                                          "frames that arrive without delay",
                                                          "perfect host clocks",
                                                          "gathering by the true pulse",
                                                          "frames of any length"};

// "a, b and 7 more".
std::string some_of(const std::vector<const Row*>& rows) {
  std::string text;
  const std::size_t named = rows.size() <= kNamedEquals + 1 ? rows.size() : kNamedEquals;
  for (std::size_t i = 0; i < named; ++i) {
    const bool is_last = i + 1 == rows.size();
    text += (i == 0 ? "" : is_last ? " and " : ", ") + rows[i]->pipeline;
  }
  return named == rows.size() ? text : fmt::format("{} and {} more", text, rows.size() - named);
}

std::string best_sentence(const Answer& answer) {
  const Series& series = evaluation::ranked_series(*answer.best, answer.ranked_by);
  const std::string place =
      answer.runnable == 1
          ? "is the only pipeline here that a rig can run"
          : fmt::format("is the best of the {} pipelines that a rig can run", answer.runnable);
  return fmt::format("{} {}: {} {} (5-95 %: {}).", answer.best->pipeline, place,
                     ranked_name(answer.ranked_by), time_text(series.median),
                     time_band_text(series.p05, series.p95));
}

std::string paper_sentence(const Results& results, const Answer& answer) {
  const Row* const paper = evaluation::find_row(results.rows, evaluation::kPaperPipeline);
  if (paper == nullptr || paper == answer.best || paper == answer.next) return "";
  const double times =
      evaluation::paired_ratio(evaluation::ranked_series(*paper, answer.ranked_by),
                               evaluation::ranked_series(*answer.best, answer.ranked_by))
          .median;
  if (std::isnan(times)) return "";
  return fmt::format("The paper's method, {}, has {} times as much.", paper->pipeline,
                     number_text(times));
}

std::string limit_sentence(const Answer& answer) {
  if (answer.limit == nullptr || std::isnan(answer.times_limit)) return "";
  const double median = evaluation::ranked_series(*answer.limit, answer.ranked_by).median;
  const std::string what = answer.limit_is_host_sync ? "Perfect host clocks would give it"
                                                     : fmt::format("{}, which knows the truth, has",
                                                                   answer.limit->pipeline);
  return fmt::format("{} {}; it has {} times that limit.", what, time_text(median),
                     number_text(answer.times_limit));
}

const evaluation::ErrorParts& ranked_parts(const Budget& budget, RankedBy ranked_by) {
  if (ranked_by == RankedBy::kExposureSpread) return budget.physical_ms;
  return ranked_by == RankedBy::kAmd ? budget.amd_ms : budget.absolute_error_ms;
}

// What limits it, and what would improve it most.
std::string budget_sentences(const Answer& answer, const Budget& budget) {
  const evaluation::ErrorParts& parts = ranked_parts(budget, answer.ranked_by);
  const double total = parts.total.mean;
  if (!(total > 0)) return "";
  std::array<std::size_t, kStageCount> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t stage) { return parts.stages[stage].mean; });
  std::string shares;
  for (const std::size_t stage : order) {
    const double share = parts.stages[stage].mean / total;
    if (share < kSmallShare) break;
    shares += fmt::format(
        "{}{} {:.0f} %", shares.empty() ? "" : ", ",
        evaluation::stage_name(budget, static_cast<evaluation::BudgetStage>(stage)), 100 * share);
  }
  if (shares.empty()) return "";
  std::string text = fmt::format("What limits it (error budget over {}): {}.",
                                 counted(parts.total.values.size(), "seed"), shares);
  const auto most = std::ranges::max_element(parts.alone, {}, &evaluation::BudgetPart::mean);
  if (most->mean < kWorthWinning * total) return text;
  const auto stage = static_cast<std::size_t>(most - parts.alone.begin());
  const bool is_phase = stage == 0 && budget.is_steered;
  return text + fmt::format(" Most would be won by {}: {:.0f} % of it.",
                            is_phase ? "perfect phases" : kIdeals[stage],
                            100 * std::min(most->mean / total, 1.0));
}

std::string sets_sentence(const Row& row) {
  if (is_unverified(row)) return "Whether its sets are right is unknown: the capture has no truth.";
  if (row.sets.emitted == 0) return "It gathers no complete set.";
  if (std::isnan(row.precision) || std::isnan(row.recall)) return "";
  if (row.precision == 1 && row.recall == 1) {
    const std::string spare =
        row.margin_ms > 0 ? fmt::format(", with {} to spare", time_text(row.margin_ms)) : "";
    return fmt::format(
        "Its sets can be trusted here: none of {} mixes pulses, no pulse is missing{}.",
        count_text(row.sets.emitted), spare);
  }
  return fmt::format(
      "Do not trust its sets: {} of them mix pulses, {} of the pulses are not whole.",
      share_text(1 - row.precision), share_text(1 - row.recall));
}

}  // namespace

const char* ranked_name(RankedBy ranked_by) {
  switch (ranked_by) {
    case RankedBy::kAmd:
      return "AMD";
    case RankedBy::kAbsoluteError:
      return "absolute error";
    case RankedBy::kExposureSpread:
      return "95 % exposure spread";
    case RankedBy::kClockSpread:
      break;
  }
  return "spread of the clocks";
}

std::string distance_text(const Results& results, const Answer& answer) {
  std::vector<std::string> sentences;
  if (!answer.equals.empty()) {
    sentences.push_back(fmt::format("These seeds cannot tell {} from it.", some_of(answer.equals)));
  }
  if (answer.next != nullptr) {
    const evaluation::Estimate& ratio = answer.to_next.ratio;
    const std::string range =
        std::isnan(ratio.low)
            ? ""
            : fmt::format(" [{}, {}]", number_text(ratio.low), number_text(ratio.high));
    sentences.push_back(fmt::format("The next, {}, has {}{} times as much.", answer.next->pipeline,
                                    number_text(ratio.value), range));
  }
  sentences.push_back(paper_sentence(results, answer));
  if (sentences.back().empty()) sentences.pop_back();
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string uncertainty_text(const Answer& answer) {
  const Row& best = *answer.best;
  std::vector<std::string> parts;
  const std::size_t seeds =
      evaluation::count_of_existing(evaluation::ranked_series(best, answer.ranked_by).values);
  if (seeds < kFewestSeeds) {
    parts.push_back(few_seeds_text(seeds));
  } else if (answer.known_within) {
    parts.push_back(fmt::format("the median of {} is known to {:.0f} %", counted(seeds, "seed"),
                                std::ceil(100 * *answer.known_within)));
  }
  const double error_ms = best.absolute_error_ms.median;
  if (answer.ranked_by == RankedBy::kAmd && error_ms > kMuchLarger * best.amd_ms.median) {
    parts.push_back(
        fmt::format("AMD hides that all cameras are {} off together", time_text(error_ms)));
  }
  if (parts.empty()) return "";
  std::string text = "Uncertain: " + parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) text += "; " + parts[i];
  return text + ".";
}

AnswerText results_answer(const Results& results, RankedBy ranked_by, const Budget* budget) {
  const Answer answer = evaluation::answer_of(results, ranked_by);
  if (answer.best == nullptr) return {.lead = "No pipeline that a rig can run has a result here."};
  const bool is_of_cables = ranked_by == RankedBy::kExposureSpread;
  AnswerText text{.lead = is_of_cables ? cables_text(results) : best_sentence(answer)};
  if (is_of_cables) {
    text.add("Best", best_sentence(answer));
    text.add("Cable", cable_sentence(results));
  }
  text.add("Others", distance_text(results, answer));
  text.add("Limit", limit_sentence(answer));
  if (budget != nullptr) text.add("Causes", budget_sentences(answer, *budget));
  text.add("Sets", sets_sentence(*answer.best));
  text.add("Certainty", uncertainty_text(answer));
  return text;
}

}  // namespace simbench::reports
