#include "evaluation/scoring/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/ports/stage.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMarginQuantile = 0.999;

Series series_of(const std::vector<SeedScore>& seeds, double MetricValues<double>::*value) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SeedScore& seed : seeds) values.push_back(seed.*value);
  return make_series(std::move(values));
}

// NaN for 0 / 0.
double ratio(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

// Sets each seed's shares of its own counts.
void add_shares(std::vector<SeedScore>& seeds) {
  for (SeedScore& seed : seeds) {
    if (seed.ground_truth == GroundTruth::kNone) continue;
    seed.seed_precision = ratio(seed.sets.pure, seed.sets.emitted);
    seed.seed_recall = ratio(seed.sets.pure, seed.sets.complete_pulses);
  }
}

// Sets a row's series and counts from the seeds' own.
struct Summary {
  const std::vector<SeedScore>& seeds;
  Row& row;

  void operator()(const SeriesPlace& place) const { row.*place.row = series_of(seeds, place.seed); }
  void operator()(std::int64_t SetCounts::*count) const {
    for (const SeedScore& seed : seeds) row.sets.*count += seed.sets.*count;
  }
  void operator()(std::int64_t FrameCounts::*count) const {
    for (const SeedScore& seed : seeds) row.frames.*count += seed.frames.*count;
  }
  void operator()(double PooledValues::*) const {}
  void operator()(std::int64_t RunCounts::*) const {}
};

GroundTruth weakest(const std::vector<SeedScore>& seeds) {
  std::optional<GroundTruth> found;
  for (const SeedScore& seed : seeds) {
    if (seed.recorded) found = std::max(found.value_or(seed.ground_truth), seed.ground_truth);
  }
  return found.value_or(GroundTruth::kNone);
}

// A line each; the notes of simulated worlds that say the same are one.
std::vector<std::string> notes_of(const std::vector<SeedScore>& seeds) {
  struct Noted {
    std::string text;
    std::uint64_t seed;
    std::uint64_t more = 0;
  };
  std::vector<Noted> noted;
  for (const SeedScore& seed : seeds) {
    for (const std::string& text : seed.cost.notes) {
      const auto known = seed.ground_truth != GroundTruth::kSimulation
                             ? noted.end()
                             : std::ranges::find(noted, text, &Noted::text);
      if (known == noted.end()) {
        noted.push_back({text, seed.seed});
      } else {
        ++known->more;
      }
    }
  }
  std::vector<std::string> notes;
  notes.reserve(noted.size());
  for (const auto& [text, seed, more] : noted) {
    notes.push_back(more == 0 ? fmt::format("repetition {}: {}", seed, text)
                              : fmt::format("repetition {} and {} more: {}", seed, more, text));
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
  return {.gathering_interval_ms =
              scenario.evaluation.gathering_interval_periods * scenario.trigger.period_ms(),
          .sources = static_cast<std::size_t>(scenario.cameras.count),
          .median = scenario.evaluation.rmdv_median};
}

SeedScore missing_score(std::uint64_t seed, const std::string& reason) {
  SeedScore score;
  score.seed = seed;
  score.recorded = false;
  score.ground_truth = GroundTruth::kNone;
  score.cost.notes = {reason};
  return score;
}

Row make_row(const scenarios::Pipeline& pipeline, std::vector<SeedScore> seeds,
             const RowSetting& setting) {
  Row row;
  row.pipeline = pipeline.name;
  copy_stages(pipeline, row);
  row.is_of_programs = pipeline.programs.has_value();
  if (pipeline.programs) row.model = pipeline.programs->model;
  add_shares(seeds);
  for (const Metric& metric : metrics(setting.kind)) {
    std::visit(Summary{seeds, row}, metric.place);
  }
  for (const SeedScore& seed : seeds) {
    row.emission_latency_max_ms =
        std::fmax(row.emission_latency_max_ms, seed.emission_latency_max_ms);
    row.unsynchronised_hosts += static_cast<std::int64_t>(seed.failures.size());
    if (seed.search) {
      if (!row.search) row.search.emplace();
      row.search->add(*seed.search);
    }
    for (const ProgramFailure& failure : seed.program_failures) {
      row.program_failures.push_back({.seed = seed.seed, .failure = failure});
    }
  }
  row.ground_truth = weakest(seeds);
  row.notes = notes_of(seeds);
  if (row.verified()) {
    row.precision = ratio(row.sets.pure, row.sets.emitted);
    row.recall = ratio(row.sets.pure, row.sets.complete_pulses);
    row.evaluated_pulses = row.sets.complete_pulses;
    row.margin_ms = setting.sources == 1 ? kNan : margin_ms(seeds, setting.gathering_interval_ms);
  } else {  // the range of a gathered set does not show how close gathering came to failing
    row.precision = row.recall = row.margin_ms = kNan;
    row.evaluated_pulses = row.sets.emitted;
  }
  row.seeds = std::move(seeds);
  return row;
}

std::size_t scored_seeds(const Row& row, const Metric& metric) {
  return count_of_existing(metric.series(row).values);
}

std::size_t scored_seeds(const Row& row) {
  std::size_t most = count_of_existing(row.amd_ms.values);
  if (most > 0) return most;
  for (const Metric& metric : metrics()) {
    if (metric.is_series()) most = std::max(most, scored_seeds(row, metric));
  }
  return most;
}

bool has_single_camera(const Row& row) {
  return row.evaluated_pulses > 0 && count_of_existing(row.amd_ms.values) == 0;
}

PublishedComparison compare(const scenarios::Published& published, const Row& row,
                            const RowSetting& setting) {
  const double bound = rmdv_bound(setting.sources, setting.median);
  return {.amd_ms = published.amd_ms,
          .rmdv_ms = published.rmdv_ms,
          .rmdv_attainable = published.rmdv_ms <= bound * published.amd_ms,
          .amd_percentile = percentile_of(published.amd_ms, row.amd_ms.values),
          .rmdv_percentile = percentile_of(published.rmdv_ms, row.rmdv_ms.values)};
}

}  // namespace simbench::evaluation
