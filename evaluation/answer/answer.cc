#include "evaluation/answer/answer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "evaluation/run/leaderboard.h"

namespace simbench::evaluation {
namespace {

// Whether its hosts read the master's clock and all else is as in the best.
bool differs_in_host_sync_alone(const Row& row, const Row& best) {
  return standing_of_stages(row, RankedBy::kClockSpread) == RowStanding::kLimit &&
         row.capture_alignment == best.capture_alignment && row.device_time == best.device_time &&
         row.gathering == best.gathering;
}

PairedComparison compared(const Row& row, const Row& best, RankedBy ranked_by) {
  return compare_together(
             {{pair_up(ranked_series(best, ranked_by).values, ranked_series(row, ranked_by).values),
               {}}})
      .front();
}

void compare_with_best(const std::vector<const Row*>& rows, Answer& answer) {
  std::vector<const Row*> others = rows;
  std::erase(others, answer.best);
  if (others.empty()) return;
  std::vector<ComparisonTask> tasks;
  tasks.reserve(others.size());
  const Series& best = ranked_series(*answer.best, answer.ranked_by);
  for (const Row* row : others) {
    tasks.push_back({pair_up(best.values, ranked_series(*row, answer.ranked_by).values), {}});
  }
  const std::vector<PairedComparison> all = compare_together(tasks);
  const auto tests = std::ranges::count_if(all, &PairedComparison::is_tested);
  std::size_t most_pairs = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    most_pairs = std::max(most_pairs, all[i].pairs);
    if (all[i].verdict != Verdict::kWorse) {
      answer.not_told_apart.push_back({others[i], all[i]});
    } else if (!answer.next) {
      answer.next = {others[i], all[i]};
    }
  }
  const std::size_t needed = fewest_pairs(static_cast<std::size_t>(tests));
  if (tests > 0 && most_pairs < needed) answer.seeds_needed = needed;
}

void find_limit(const std::vector<const Row*>& limits, Answer& answer) {
  const auto found = std::ranges::find_if(
      limits, [&answer](const Row* row) { return differs_in_host_sync_alone(*row, *answer.best); });
  if (found == limits.end()) return;
  answer.limit = {*found, compared(**found, *answer.best, answer.ranked_by)};
  answer.times_limit = paired_ratio(ranked_series(*answer.best, answer.ranked_by),
                                    ranked_series(**found, answer.ranked_by))
                           .median;
}

// Whether another row has about the same absolute error, and a smaller AMD and host clock error.
bool is_contradicted(const Row& row, const std::vector<const Row*>& rows) {
  constexpr double kAboutTheSame = 1.25;
  constexpr double kClearly = 1.05;
  return std::ranges::any_of(rows, [&](const Row* other) {
    return other->absolute_error_ms.median < kAboutTheSame * row.absolute_error_ms.median &&
           kClearly * other->amd_ms.median < row.amd_ms.median &&
           kClearly * other->host_error_ms.median < row.host_error_ms.median;
  });
}

// The first row; ranked by the absolute error the first that nothing contradicts.
const Row* first_of(const std::vector<const Row*>& rows, RankedBy ranked_by) {
  if (rows.empty()) return nullptr;
  if (ranked_by != RankedBy::kAbsoluteError) return rows.front();
  const auto found =
      std::ranges::find_if(rows, [&rows](const Row* row) { return !is_contradicted(*row, rows); });
  return found == rows.end() ? rows.front() : *found;
}

// The bias that all rows have within a tenth, if it is most of their errors.
std::optional<double> shared_bias_ms(const std::vector<const Row*>& rows) {
  constexpr double kSpread = 0.1;
  double low = rows.front()->bias_ms.median;
  double high = low;
  for (const Row* row : rows) {
    const double bias_ms = row->bias_ms.median;
    if (!(std::abs(bias_ms) > row->absolute_error_ms.median / 2)) return std::nullopt;
    low = std::min(low, bias_ms);
    high = std::max(high, bias_ms);
  }
  if (rows.size() < 2 || high - low > kSpread * std::abs(low)) return std::nullopt;
  return (low + high) / 2;
}

}  // namespace

const Row* best_of(const std::vector<const Row*>& rows, RankedBy ranked_by) {
  return first_of(ranked_rows(rows, RowStanding::kRanked, ranked_by), ranked_by);
}

const Row* best_of(const Results& results) {
  return best_of(pointers_to(results.rows), ranking_of(results));
}

Answer answer_of(const Results& results) {
  Answer answer{.ranked_by = ranking_of(results)};
  const std::vector<const Row*> all = pointers_to(results.rows);
  for (const Row& row : results.rows) {
    ReasonedStanding standing = standing_of(row, answer.ranked_by);
    if (standing.is != RowStanding::kFailed) continue;
    answer.failed.push_back({.row = &row, .reason = std::move(standing.reason)});
  }
  const std::vector<const Row*> rows = ranked_rows(all, RowStanding::kRanked, answer.ranked_by);
  if (rows.empty()) return answer;
  answer.ranked = rows.size();
  answer.best = first_of(rows, answer.ranked_by);
  if (answer.ranked_by == RankedBy::kAbsoluteError) answer.shared_bias_ms = shared_bias_ms(rows);
  compare_with_best(rows, answer);
  find_limit(ranked_rows(all, RowStanding::kLimit, answer.ranked_by), answer);
  const std::vector<double>& values = ranked_series(*answer.best, answer.ranked_by).values;
  const double relative =
      median_interval(values, static_cast<std::int64_t>(count_of_existing(values))).relative;
  if (count_of_existing(values) > 1 && !std::isnan(relative)) answer.known_within = relative;
  return answer;
}

}  // namespace simbench::evaluation
