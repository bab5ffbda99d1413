#include "evaluation/sweep/sweep_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

Series series_of(std::span<const SweepScore> seeds, double SweepScore::*member) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SweepScore& seed : seeds) values.push_back(seed.*member);
  return make_series(std::move(values));
}

double sum_of(std::span<const SweepScore> seeds, double SweepScore::*member) {
  double sum = 0;
  for (const SweepScore& seed : seeds) sum += seed.*member;
  return sum;
}

std::vector<Series> host_series(std::span<const SweepScore> seeds) {
  std::size_t hosts = 0;
  for (const SweepScore& seed : seeds) hosts = std::max(hosts, seed.host_errors_ms.size());
  std::vector<Series> all;
  for (std::size_t host = 0; host < hosts; ++host) {
    std::vector<double> errors;
    for (const SweepScore& seed : seeds) {
      errors.push_back(host < seed.host_errors_ms.size()
                           ? std::fabs(seed.host_errors_ms[host])
                           : std::numeric_limits<double>::quiet_NaN());
    }
    all.push_back(make_series(std::move(errors)));
  }
  return all;
}

}  // namespace

std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  SIMBENCH_ASSERT(scores.size() == plan.runs(), "a score for every run");
  std::vector<ResponseRow> rows;
  for (std::size_t first = 0; first < scores.size(); first += plan.seeds) {
    const std::span<const SweepScore> seeds = std::span(scores).subspan(first, plan.seeds);
    const SweepRun run = plan.run(first);
    const double pure = sum_of(seeds, &SweepScore::pure_sets);
    rows.push_back({.point = run.point,
                    .pipeline = run.pipeline,
                    .amd_ms = series_of(seeds, &SweepScore::amd_ms),
                    .absolute_error_ms = series_of(seeds, &SweepScore::absolute_error_ms),
                    .host_error_ms = series_of(seeds, &SweepScore::host_error_ms),
                    .margin_ms = series_of(seeds, &SweepScore::margin_ms),
                    .precision = pure / sum_of(seeds, &SweepScore::emitted_sets),
                    .recall = pure / sum_of(seeds, &SweepScore::complete_pulses),
                    .hosts = host_series(seeds)});
  }
  return rows;
}

}  // namespace simbench::evaluation
