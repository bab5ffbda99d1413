#include "evaluation/rows.h"

#include <cmath>
#include <utility>

#include "evaluation/statistics.h"

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

// A share of each seed's own counts.
Series share_of(const std::vector<SeedScore>& seeds, std::int64_t SetCounts::*whole) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SeedScore& seed : seeds) values.push_back(ratio(seed.sets.pure, seed.sets.*whole));
  return make_series(std::move(values));
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
  row.precision = ratio(sets.pure, sets.emitted);
  row.recall = ratio(sets.pure, sets.complete_pulses);
  row.evaluated_pulses = sets.complete_pulses;
  row.margin_ms = margin_ms(seeds, setting.gathering_interval_ms);
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
