#include "reports/results/results_answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "evaluation/run/leaderboard.h"
#include "recording/collected.h"
#include "recording/counted.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/lever_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Answer;
using evaluation::Levers;
using evaluation::RankedBy;
using evaluation::Results;
using evaluation::Row;
using evaluation::Series;

constexpr std::size_t kNamedEquals = 2;  // of those that cannot be told from the best
constexpr double kMuchLarger = 3;        // absolute error / AMD that deserves a word

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

const char* ranked_title(const Answer& answer) {
  return evaluation::ranked_metric(answer.ranked_by).title;
}

std::string best_sentence(const Answer& answer) {
  const Series& series = evaluation::ranked_series(*answer.best, answer.ranked_by);
  if (answer.seeds_needed > 0) {
    return fmt::format(
        "{} has the smallest {} of the {} pipelines that a rig can run, in too few seeds for a "
        "verdict: {} (5-95 %: {}).",
        answer.best->pipeline, ranked_title(answer), answer.ranked, time_text(series.median),
        time_band_text(series.p05, series.p95));
  }
  const std::string place =
      answer.ranked > 1       ? fmt::format("{} is the best of the {} pipelines that a rig can run",
                                            certainty_clause(answer), answer.ranked)
      : answer.failed.empty() ? " is the only pipeline here that a rig can run"
                              : " is the only pipeline that a rig can run and that did not fail";
  return fmt::format("{}{}: {} {} (5-95 %: {}).", answer.best->pipeline, place,
                     ranked_title(answer), time_text(series.median),
                     time_band_text(series.p05, series.p95));
}

bool is_calibrated(const Row& row) { return parse_device_time_name(row.device_time).calibrated; }

// The paper's row that is like the best: where an absolute error ranks, one with a calibration is
// not compared with one without. Null: there is none.
const Row* comparable_paper(const Results& results, const Answer& answer) {
  const Row* const paper = evaluation::find_row(results.rows, evaluation::kPaperPipeline);
  if (paper == nullptr || answer.ranked_by != RankedBy::kAbsoluteError) return paper;
  if (is_calibrated(*paper) == is_calibrated(*answer.best)) return paper;
  const std::string twin = paper->device_time + "_calibrated";
  const auto found = std::ranges::find_if(results.rows, [&](const Row& row) {
    return row.host_sync == paper->host_sync && row.gathering == paper->gathering &&
           row.device_time == twin;
  });
  return found == results.rows.end() ? nullptr : &*found;
}

std::string paper_sentence(const Results& results, const Answer& answer) {
  const Row* const paper = comparable_paper(results, answer);
  const bool is_named =
      paper == nullptr || paper == answer.best || (answer.next && paper == answer.next->row);
  if (is_named ||
      evaluation::standing_of(*paper, answer.ranked_by).is != evaluation::RowStanding::kRanked) {
    return "";
  }
  const double times =
      evaluation::paired_ratio(evaluation::ranked_series(*paper, answer.ranked_by),
                               evaluation::ranked_series(*answer.best, answer.ranked_by))
          .median;
  if (std::isnan(times)) return "";
  return fmt::format("The paper's method, {}, has {} times as much.", paper->pipeline,
                     number_text(times));
}

std::string limit_sentence(const Answer& answer) {
  if (!answer.limit || std::isnan(answer.times_limit)) return "";
  const double median = evaluation::ranked_series(*answer.limit->row, answer.ranked_by).median;
  const evaluation::PairedComparison& limit = answer.limit->to_best;
  if (limit.verdict == evaluation::Verdict::kWorse) {
    return fmt::format(
        "Perfect host clocks would give it {}, more than it has: errors of the clocks and of the "
        "rest cancel in its {}, which hides what really differs.",
        time_text(median), ranked_title(answer));
  }
  if (limit.verdict == evaluation::Verdict::kNoDifferenceSeen || answer.times_limit < 1) {
    return fmt::format(
        "Perfect host clocks would give it {}, which these seeds cannot tell from what it has.",
        time_text(median));
  }
  return fmt::format("Perfect host clocks would give it {}; it has {} times that limit.",
                     time_text(median), number_text(answer.times_limit));
}

constexpr double kMuchLost = 0.001;  // of the pulses due: belongs into the first sentence

// Whether it is known how many pulses were due.
bool knows_due(const Row& row) { return row.verified() && row.sets.due_pulses > 0; }

// The share of the pulses due that not all cameras delivered.
double lost_share(const Row& row) {
  if (!knows_due(row)) return 0;
  return 1 -
         static_cast<double>(row.sets.complete_pulses) / static_cast<double>(row.sets.due_pulses);
}

// "1 440 of 1 920 pulses due are lost: 1 440 were not exposed by all cameras (reason)."; "" where
// that is little.
std::string lost_sentence(const Results& results, const Row& row) {
  if (lost_share(row) <= kMuchLost) return "";
  const evaluation::SetCounts& counts = row.sets;
  const std::int64_t unexposed = counts.due_pulses - counts.exposed_pulses;
  const std::int64_t undelivered = counts.exposed_pulses - counts.complete_pulses;
  std::vector<std::string> parts;
  if (unexposed > 0) {
    parts.push_back(fmt::format("{} not exposed by all cameras", count_text(unexposed)));
  }
  if (undelivered > 0) {
    parts.push_back(fmt::format("{} exposed and not delivered by all", count_text(undelivered)));
  }
  std::string text =
      fmt::format("But {} of the {} pulses due are lost: {}.", share_text(lost_share(row)),
                  count_text(counts.due_pulses), fmt::join(parts, ", "));
  for (const std::string& reason : results.loss_reasons) text += " " + reason + ".";
  return text;
}

std::string sets_sentence(const Row& row) {
  if (is_unverified(row)) return "Whether its sets are right is unknown: the capture has no truth.";
  if (row.sets.emitted == 0) return "It gathers no complete set.";
  if (std::isnan(row.precision) || std::isnan(row.recall)) return "";
  const evaluation::SetCounts& counts = row.sets;
  const std::int64_t mixed = counts.emitted - counts.pure;
  const std::string found =
      knows_due(row) ? fmt::format(
                           "of {} pulses due {} were exposed by all cameras, {} delivered "
                           "by all and {} found whole",
                           count_text(counts.due_pulses), count_text(counts.exposed_pulses),
                           count_text(counts.complete_pulses), count_text(counts.pure))
                     : fmt::format("of {} pulses that all cameras delivered {} are found whole",
                                   count_text(counts.complete_pulses), count_text(counts.pure));
  if (mixed > 0 || row.recall < 1) {
    return fmt::format("Do not trust its sets: {} of {} mix pulses; {}.", count_text(mixed),
                       count_text(counts.emitted), found);
  }
  const std::string spare =
      row.margin_ms > 0 ? fmt::format(", with {} to spare", time_text(row.margin_ms)) : "";
  if (knows_due(row) && counts.pure == counts.due_pulses) {
    return fmt::format(
        "Its sets can be trusted here: none of {} mixes pulses, no pulse is missing{}.",
        count_text(counts.emitted), spare);
  }
  return fmt::format("Its sets can be trusted here: none of {} mixes pulses{}; {}.",
                     count_text(counts.emitted), spare, found);
}

}  // namespace

std::string certainty_clause(const Answer& answer) {
  if (answer.not_told_apart.empty() || answer.seeds_needed > 0) return "";
  return fmt::format(", with {} that these seeds cannot tell from it,",
                     answer.not_told_apart.size());
}

std::string failed_text(const Answer& answer) {
  std::vector<std::string> reasons;  // in order of their first rows
  for (const evaluation::FailedRow& failed : answer.failed) {
    if (std::ranges::count(reasons, failed.reason) == 0) reasons.push_back(failed.reason);
  }
  std::vector<std::string> sentences;
  for (const std::string& reason : reasons) {
    std::vector<const Row*> rows;
    for (const evaluation::FailedRow& failed : answer.failed) {
      if (failed.reason == reason) rows.push_back(failed.row);
    }
    sentences.push_back(fmt::format("{} failed: {}.", some_of(rows), reason));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

namespace {

// "4 seeds are too few for a verdict (8 would do); in all 4 it has less than a, b and 7 more."
std::string too_few_sentence(const Answer& answer) {
  std::vector<const Row*> always;
  std::size_t pairs = 0;
  for (const evaluation::ComparedRow& other : answer.not_told_apart) {
    pairs = std::max(pairs, other.to_best.pairs);
  }
  for (const evaluation::ComparedRow& other : answer.not_told_apart) {
    if (other.to_best.higher == pairs) always.push_back(other.row);
  }
  const std::string few =
      fmt::format("{} {} too few for a verdict ({} would do)", counted(pairs, "seed"),
                  pairs == 1 ? "is" : "are", answer.seeds_needed);
  if (always.empty()) return few + ".";
  return fmt::format("{}; in {} it has less than {}.", few,
                     pairs == 1 ? "this one" : fmt::format("all {}", pairs), some_of(always));
}

}  // namespace

std::string distance_text(const Results& results, const Answer& answer) {
  std::vector<std::string> sentences;
  if (answer.seeds_needed > 0) {
    sentences.push_back(too_few_sentence(answer));
  } else if (!answer.not_told_apart.empty()) {
    sentences.push_back(
        fmt::format("Not told apart: {}.",
                    some_of(collected(answer.not_told_apart, &evaluation::ComparedRow::row))));
  }
  if (answer.next) {
    const evaluation::Estimate& ratio = answer.next->to_best.ratio;
    const std::string range =
        std::isnan(ratio.low)
            ? ""
            : fmt::format(" [{}, {}]", number_text(ratio.low), number_text(ratio.high));
    sentences.push_back(fmt::format("The next, {}, has {}{} times as much.",
                                    answer.next->row->pipeline, number_text(ratio.value), range));
  }
  sentences.push_back(paper_sentence(results, answer));
  if (sentences.back().empty()) sentences.pop_back();
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string load_text(const Results& results) {
  if (results.load_reality.empty()) return "";
  return capitalised(
      fmt::format("{}. See `simbench reality`.", fmt::join(results.load_reality, "; ")));
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
  if (answer.shared_bias_ms) {
    parts.push_back(fmt::format("all rows share a bias of {}, which swamps what tells them apart",
                                time_text(*answer.shared_bias_ms)));
  }
  if (parts.empty()) return "";
  std::string text = capitalised(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) text += "; " + parts[i];
  return text + ".";
}

namespace {

AnswerText words_of(const Results& results, const Answer& answer, const Levers* levers) {
  if (answer.best == nullptr) {
    AnswerText text{.lead = answer.failed.empty()
                                ? "No pipeline that a rig can run has a result here."
                                : "Every pipeline that a rig can run failed."};
    if (!answer.failed.empty()) {
      const std::string lost = lost_sentence(results, *answer.failed.front().row);
      if (!lost.empty()) text.lead += " " + lost;
    }
    text.add("Failed", failed_text(answer));
    return text;
  }
  const bool is_of_cables = answer.ranked_by == RankedBy::kExposureSpread;
  AnswerText text{.lead = is_of_cables ? cables_text(results) : best_sentence(answer)};
  if (const std::string lost = lost_sentence(results, *answer.best); !lost.empty()) {
    text.lead += " " + lost;
  }
  if (is_of_cables) {
    text.add("Best", best_sentence(answer));
    text.add("Cable", cable_sentence(results));
  }
  text.add("Others", distance_text(results, answer));
  text.add("Failed", failed_text(answer));
  text.add("Limit", limit_sentence(answer));
  text.add("Sets", sets_sentence(*answer.best));
  if (levers != nullptr) {
    text.add("To improve it", levers_text(*levers, answer.ranked_by, results.seed_count));
  }
  text.add("Uncertain", uncertainty_text(answer));
  return text;
}

// What changes the meaning of the numbers; the first note stands for all.
std::string warnings_text(const Results& results, const ResultsAnswer& answer,
                          const std::vector<std::string>& warnings) {
  std::vector<std::string> sentences;
  for (const std::vector<std::string>* each : {&warnings, &results.warnings}) {
    for (const std::string& warning : *each) {
      // The lead names what loses pulses by its pointer, the warning by its file or option.
      const bool is_said = std::ranges::any_of(results.loss_reasons, [&](const std::string& said) {
        return warning.ends_with(said.substr(std::min(said.find(": "), said.size()))) &&
               answer.text.lead.find(said) != std::string::npos;
      });
      if (!is_said) sentences.push_back(warning + ".");
    }
  }
  const Row* const best = answer.data.best;
  if (best != nullptr && !best->notes.empty()) {
    sentences.push_back(fmt::format("{} of {}: {}.", counted(best->notes.size(), "note"),
                                    best->pipeline, best->notes.front()));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace

ResultsAnswer results_answer(const Results& results, std::optional<Levers> levers,
                             const std::vector<std::string>& warnings) {
  ResultsAnswer answer{.data = evaluation::answer_of(results), .levers = std::move(levers)};
  answer.text = words_of(results, answer.data, answer.levers ? &*answer.levers : nullptr);
  answer.text.add("Load", load_text(results));
  answer.text.add("Warnings", warnings_text(results, answer, warnings));
  return answer;
}

}  // namespace simbench::reports
