#include "evaluation/answer/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "algorithms/device_time/variants.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/program_failures.h"

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

bool shares_no_zero(const DeviceTimeEntry* entry) {
  return entry != nullptr &&
         !entry->make(check_parameters(entry->info.parameters, {}))->shares_zero();
}

constexpr const char* kNoPureSet = "no gathered set is of one pulse";

// Whether sets have a part in what is ranked.
bool is_of_sets(RankedBy ranked_by) {
  return ranked_by != RankedBy::kClockSpread && ranked_by != RankedBy::kExposureSpread &&
         ranked_by != RankedBy::kHostError;
}

Outcome outcome_of(const Row& row) {
  Outcome outcome = {.unsynchronised_hosts = static_cast<double>(row.unsynchronised_hosts),
                     .sets = static_cast<double>(row.sets.emitted),
                     .pure_sets = static_cast<double>(row.sets.pure),
                     .complete_pulses = static_cast<double>(row.sets.complete_pulses)};
  if (!row.verified()) outcome.pure_sets = outcome.complete_pulses = kNan;
  return outcome;
}

bool has_value(const Row& row, RankedBy ranked_by) {
  return !std::isnan(ranked_series(row, ranked_by).median);
}

// Whether no set is whole although the clocks are right: the exposures or the delays of a pulse lie
// further apart than gathering takes for one pulse.
bool is_window_too_small(const Row& row) {
  constexpr double kFarBelow = 0.25;
  const bool are_clocks_off = row.host_error_ms.median > kFarBelow * row.amd_ms.median;
  return row.verified() && row.sets.pure == 0 && row.margin_ms < 0 && !are_clocks_off;
}

std::string failure_of(const Row& row, RankedBy ranked_by) {
  if (!has_value(row, ranked_by) && !row.notes.empty()) return row.notes.front();
  std::string failure = failure_text(outcome_of(row), ranked_by);
  if (failure == kNoPureSet && is_window_too_small(row)) {
    failure += fmt::format(
        ": its stamps of a pulse lie {:.3g} ms apart, beyond gathering's interval "
        "(/evaluation/gathering_interval_periods)",
        row.amd_ms.median);
  }
  if (!failure.empty() || has_value(row, ranked_by)) return failure;
  return fmt::format("it has no {}", ranked_metric(ranked_by).title);
}

}  // namespace

const char* standing_id(RowStanding standing) {
  return standing == RowStanding::kRanked ? "ranked" : standing_name(standing);
}

const char* standing_name(RowStanding standing) {
  switch (standing) {
    case RowStanding::kRanked:
      return "";
    case RowStanding::kFailed:
      return "failed";
    case RowStanding::kReference:
      return "reference";
    case RowStanding::kLimit:
      break;
  }
  return "limit";
}

RowStanding standing_of_stages(const Row& row, RankedBy ranked_by) {
  const bool knows_clocks = is_oracle(find_algorithm<HostSyncEntry>(row.host_sync));
  if (ranked_by == RankedBy::kExposureSpread && row.capture_alignment.empty()) {
    return RowStanding::kReference;
  }
  if (ranked_by == RankedBy::kClockSpread) {
    return knows_clocks ? RowStanding::kLimit : RowStanding::kRanked;
  }
  const DeviceTimeName device_time = parse_device_time_name(row.device_time);
  const auto* const entry = find_algorithm<DeviceTimeEntry>(device_time.base);
  if (knows_clocks || needs_truth(entry) ||
      needs_truth(find_algorithm<CaptureAlignmentEntry>(row.capture_alignment)) ||
      needs_truth(find_algorithm<GatheringEntry>(row.gathering))) {
    return RowStanding::kLimit;
  }
  return shares_no_zero(entry) ? RowStanding::kReference : RowStanding::kRanked;
}

ReasonedStanding standing_of(const Row& row, RankedBy ranked_by) {
  if (!row.program_failures.empty()) {
    return {.is = RowStanding::kFailed, .reason = program_failure_text(row)};
  }
  const RowStanding of_stages = standing_of_stages(row, ranked_by);
  if (of_stages != RowStanding::kRanked) return {.is = of_stages};
  std::string failure = failure_of(row, ranked_by);
  if (failure.empty()) return {};
  return {.is = RowStanding::kFailed, .reason = std::move(failure)};
}

std::string failure_text(const Outcome& outcome, RankedBy ranked_by) {
  if (outcome.unsynchronised_hosts > 0) {
    return fmt::format("hosts were not synchronised ({} over all seeds)",
                       outcome.unsynchronised_hosts);
  }
  if (!is_of_sets(ranked_by)) return "";
  if (outcome.complete_pulses == 0) return "no pulse was delivered by all cameras";
  if (outcome.sets == 0) return "no complete set was gathered";
  if (outcome.pure_sets == 0) return kNoPureSet;
  return "";
}

std::vector<const Row*> ranked_rows(const std::vector<const Row*>& rows, RowStanding standing,
                                    RankedBy ranked_by) {
  std::vector<const Row*> found;
  for (const Row* row : rows) {
    if (has_value(*row, ranked_by) && standing_of(*row, ranked_by).is == standing) {
      found.push_back(row);
    }
  }
  // A share that is unknown is no advantage.
  const auto known = [](double share) { return std::isnan(share) ? 0 : share; };
  std::ranges::stable_sort(found, {}, [&](const Row* row) {
    return std::tuple(ranked_series(*row, ranked_by).median, -known(row->recall),
                      -known(row->precision));
  });
  return found;
}

}  // namespace simbench::evaluation
