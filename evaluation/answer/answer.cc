#include "evaluation/answer/answer.h"

#include <algorithm>
#include <cmath>

#include "algorithms/device_time/variants.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "evaluation/run/leaderboard.h"

namespace simbench::evaluation {
namespace {

template <class Entry>
bool needs_truth(const Entry* entry) {
  return entry != nullptr &&
         (!entry->make || std::ranges::count(entry->info.needs, Need::kTruth) > 0);
}

// Whether its hosts read the master's clock.
bool is_oracle(const HostSyncEntry* entry) {
  if (entry == nullptr) return false;
  const Parameters parameters = check_parameters(entry->info.parameters, {});
  return entry->make(parameters)->initial_clocks() == InitialClocks::kMaster;
}

bool has_value(const Row& row, RankedBy ranked_by) {
  return !std::isnan(ranked_series(row, ranked_by).median);
}

// The rows of a standing that have a value, in order of their medians.
std::vector<const Row*> rows_of(const std::vector<const Row*>& all, RowStanding standing,
                                RankedBy ranked_by) {
  std::vector<const Row*> rows;
  for (const Row* row : all) {
    if (standing_by(*row, ranked_by) == standing && has_value(*row, ranked_by)) rows.push_back(row);
  }
  std::ranges::stable_sort(
      rows, {}, [ranked_by](const Row* row) { return ranked_series(*row, ranked_by).median; });
  return rows;
}

void compare_with_best(const std::vector<const Row*>& rows, Answer& answer) {
  std::vector<ComparisonTask> tasks;
  const Series& best = ranked_series(*answer.best, answer.ranked_by);
  for (const Row* row : rows) {
    if (row == answer.best) continue;
    tasks.push_back({pair_up(best.values, ranked_series(*row, answer.ranked_by).values), {}});
  }
  const std::vector<PairedComparison> compared = compare_together(tasks);
  auto comparison = compared.begin();
  for (const Row* row : rows) {
    if (row == answer.best) continue;
    if (comparison->verdict != Verdict::kWorse) {
      answer.equals.push_back(row);
    } else if (answer.next == nullptr) {
      answer.next = row;
      answer.to_next = *comparison;
    }
    ++comparison;
  }
}

bool differs_in_host_sync_alone(const Row& row, const Row& best) {
  return is_oracle(find_algorithm<HostSyncEntry>(row.host_sync)) &&
         row.device_time == best.device_time && row.gathering == best.gathering;
}

void find_limit(const std::vector<const Row*>& limits, Answer& answer) {
  if (limits.empty()) return;
  const auto found = std::ranges::find_if(
      limits, [&answer](const Row* row) { return differs_in_host_sync_alone(*row, *answer.best); });
  answer.limit_is_host_sync = found != limits.end();
  answer.limit = answer.limit_is_host_sync ? *found : limits.front();
  answer.times_limit = paired_ratio(ranked_series(*answer.best, answer.ranked_by),
                                    ranked_series(*answer.limit, answer.ranked_by))
                           .median;
}

}  // namespace

RankedBy ranked_by(scenarios::TableKind table) {
  switch (table) {
    case scenarios::TableKind::kPipelines:
      return RankedBy::kAmd;
    case scenarios::TableKind::kLeaderboard:
      return RankedBy::kAbsoluteError;
    case scenarios::TableKind::kAlignment:
      break;
  }
  return RankedBy::kExposureSpread;
}

RowStanding standing_of(const Row& row) {
  const DeviceTimeName device_time = parse_device_time_name(row.device_time);
  const DeviceTimeEntry* const entry = find_algorithm<DeviceTimeEntry>(device_time.base);
  if (is_oracle(find_algorithm<HostSyncEntry>(row.host_sync)) || needs_truth(entry) ||
      needs_truth(find_algorithm<CaptureAlignmentEntry>(row.capture_alignment)) ||
      needs_truth(find_algorithm<GatheringEntry>(row.gathering))) {
    return RowStanding::kLimit;
  }
  const bool is_relative =
      entry != nullptr && entry->make(check_parameters(entry->info.parameters, {}))->relative();
  return is_relative ? RowStanding::kReference : RowStanding::kRunnable;
}

RowStanding standing_by(const Row& row, RankedBy ranked_by) {
  if (ranked_by == RankedBy::kExposureSpread && row.capture_alignment.empty()) {
    return RowStanding::kReference;
  }
  if (ranked_by != RankedBy::kClockSpread) return standing_of(row);
  return is_oracle(find_algorithm<HostSyncEntry>(row.host_sync)) ? RowStanding::kLimit
                                                                 : RowStanding::kRunnable;
}

const char* standing_name(RowStanding standing) {
  switch (standing) {
    case RowStanding::kRunnable:
      return "";
    case RowStanding::kReference:
      return "reference";
    case RowStanding::kLimit:
      return "limit";
  }
  return "";
}

const Row* best_of(const std::vector<const Row*>& rows, RankedBy ranked_by) {
  const std::vector<const Row*> runnable = rows_of(rows, RowStanding::kRunnable, ranked_by);
  return runnable.empty() ? nullptr : runnable.front();
}

const Series& ranked_series(const Row& row, RankedBy ranked_by) {
  switch (ranked_by) {
    case RankedBy::kAmd:
      return row.amd_ms;
    case RankedBy::kAbsoluteError:
      return row.absolute_error_ms;
    case RankedBy::kExposureSpread:
      return row.exposure_spread_p95_ms;
    case RankedBy::kClockSpread:
      break;
  }
  return row.clock_spread_ms;
}

Answer answer_of(const Results& results, RankedBy ranked_by) {
  Answer answer{.ranked_by = ranked_by};
  std::vector<const Row*> all;
  all.reserve(results.rows.size());
  for (const Row& row : results.rows) all.push_back(&row);
  std::vector<const Row*> rows = rows_of(all, RowStanding::kRunnable, ranked_by);
  if (rows.empty() && ranked_by == RankedBy::kAmd) {
    answer.ranked_by = RankedBy::kAbsoluteError;
    rows = rows_of(all, RowStanding::kRunnable, answer.ranked_by);
  }
  if (rows.empty()) return answer;
  answer.runnable = rows.size();
  answer.best = rows.front();
  compare_with_best(rows, answer);
  find_limit(rows_of(all, RowStanding::kLimit, answer.ranked_by), answer);
  const std::vector<double>& values = ranked_series(*answer.best, answer.ranked_by).values;
  const double relative =
      median_interval(values, static_cast<std::int64_t>(count_of_existing(values))).relative;
  if (count_of_existing(values) > 1 && !std::isnan(relative)) answer.known_within = relative;
  return answer;
}

}  // namespace simbench::evaluation
