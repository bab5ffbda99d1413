#include "evaluation/scoring/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMarginQuantile = 0.999;

Series series_of(const std::vector<SeedScore>& seeds, double SeedScore::*score) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SeedScore& seed : seeds) values.push_back(seed.*score);
  return make_series(std::move(values));
}

// NaN for 0 / 0.
double ratio(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

bool is_verified(const SeedScore& seed) { return seed.ground_truth != GroundTruth::kNone; }

// A share of each seed's own counts.
Series share_of(const std::vector<SeedScore>& seeds, std::int64_t SetCounts::*whole) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SeedScore& seed : seeds) {
    values.push_back(is_verified(seed) ? ratio(seed.sets.pure, seed.sets.*whole) : kNan);
  }
  return make_series(std::move(values));
}

GroundTruth weakest(const std::vector<SeedScore>& seeds) {
  std::optional<GroundTruth> found;
  for (const SeedScore& seed : seeds) {
    if (seed.recorded) found = std::max(found.value_or(seed.ground_truth), seed.ground_truth);
  }
  return found.value_or(GroundTruth::kNone);
}

std::vector<std::string> notes_of(const std::vector<SeedScore>& seeds) {
  std::vector<std::string> notes;
  for (const SeedScore& seed : seeds) {
    for (const std::string& note : seed.cost.notes) {
      notes.push_back(fmt::format("repetition {}: {}", seed.seed, note));
    }
  }
  return notes;
}

double margin_ms(const std::vector<SeedScore>& seeds, double gathering_interval_ms) {
  std::vector<double> spreads;
  for (const SeedScore& seed : seeds) {
    for (const PulseScore& pulse : seed.pulses) spreads.push_back(pulse.spread_ms);
  }
  return gathering_interval_ms - quantile(std::move(spreads), kMarginQuantile);
}

}  // namespace

RowSetting row_setting(const scenarios::Scenario& scenario) {
  const double period_ms = 1000 / scenario.trigger.rate_hz;
  return {.gathering_interval_ms = scenario.evaluation.gathering_interval_periods * period_ms,
          .sources = static_cast<std::size_t>(scenario.cameras.count),
          .median = median_kind(scenario.evaluation.rmdv_median)};
}

SeedScore missing_score(std::uint64_t seed, const std::string& reason) {
  SeedScore score;
  score.seed = seed;
  score.recorded = false;
  score.ground_truth = GroundTruth::kNone;
  for (double SeedScore::*quantity :
       {&SeedScore::amd_ms, &SeedScore::rmdv_ms, &SeedScore::absolute_error_ms, &SeedScore::bias_ms,
        &SeedScore::host_error_ms, &SeedScore::exposure_spread_ms, &SeedScore::offline_amd_ms,
        &SeedScore::spread_in_host_ms, &SeedScore::spread_between_hosts_ms, &SeedScore::trend_ms,
        &SeedScore::share_below_half_period}) {
    score.*quantity = kNan;
  }
  score.cost.notes = {reason};
  return score;
}

Row make_row(const scenarios::Pipeline& pipeline, std::vector<SeedScore> seeds,
             const RowSetting& setting) {
  Row row;
  row.pipeline = pipeline.name;
  row.host_sync = pipeline.host_sync;
  row.device_time = pipeline.device_time;
  row.gathering = pipeline.gathering;
  row.amd_ms = series_of(seeds, &SeedScore::amd_ms);
  row.rmdv_ms = series_of(seeds, &SeedScore::rmdv_ms);
  row.absolute_error_ms = series_of(seeds, &SeedScore::absolute_error_ms);
  row.bias_ms = series_of(seeds, &SeedScore::bias_ms);
  row.host_error_ms = series_of(seeds, &SeedScore::host_error_ms);
  row.exposure_spread_ms = series_of(seeds, &SeedScore::exposure_spread_ms);

  row.set_amd_ms = series_of(seeds, &SeedScore::set_amd_ms);
  row.set_absolute_error_ms = series_of(seeds, &SeedScore::set_absolute_error_ms);
  row.emission_latency_ms = series_of(seeds, &SeedScore::emission_latency_ms);

  row.seed_precision = share_of(seeds, &SetCounts::emitted);
  row.seed_recall = share_of(seeds, &SetCounts::complete_pulses);

  SetCounts& sets = row.sets;
  for (const SeedScore& seed : seeds) {
    sets.emitted += seed.sets.emitted;
    sets.pure += seed.sets.pure;
    sets.complete_pulses += seed.sets.complete_pulses;
    sets.discarded_frames += seed.sets.discarded_frames;
    sets.partial += seed.sets.partial;
    sets.index_errors += seed.sets.index_errors;
    row.emission_latency_max_ms =
        std::fmax(row.emission_latency_max_ms, seed.emission_latency_max_ms);
    row.frames.expected += seed.frames.expected;
    row.frames.delivered += seed.frames.delivered;
    row.frames.dropped += seed.frames.dropped;
    row.unsynchronised_hosts += static_cast<std::int64_t>(seed.failures.size());
  }
  row.ground_truth = weakest(seeds);
  row.notes = notes_of(seeds);
  if (row.verified()) {
    row.precision = ratio(sets.pure, sets.emitted);
    row.recall = ratio(sets.pure, sets.complete_pulses);
    row.evaluated_pulses = sets.complete_pulses;
    row.margin_ms = margin_ms(seeds, setting.gathering_interval_ms);
  } else {  // the range of a gathered set says nothing of how close it came to failing
    row.precision = row.recall = row.margin_ms = kNan;
    row.evaluated_pulses = sets.emitted;
  }
  row.seeds = std::move(seeds);
  return row;
}

PublishedComparison compare(const scenarios::Published& published, const Row& row,
                            const RowSetting& setting) {
  const double bound = rmdv_bound(setting.sources, setting.median);
  return {.amd_ms = published.amd_ms,
          .rmdv_ms = published.rmdv_ms,
          .amd_inside = inside(published.amd_ms, row.amd_ms),
          .rmdv_inside = inside(published.rmdv_ms, row.rmdv_ms),
          .rmdv_attainable = published.rmdv_ms <= bound * published.amd_ms,
          .amd_percentile = percentile_of(published.amd_ms, row.amd_ms.values),
          .rmdv_percentile = percentile_of(published.rmdv_ms, row.rmdv_ms.values)};
}

}  // namespace simbench::evaluation
