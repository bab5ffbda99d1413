#include "evaluation/sweep/sweep_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"
#include "recording/number_in.h"
#include "recording/program_failure.h"

namespace simbench::evaluation {
namespace {

std::size_t place_of(std::string_view column, ResultKind kind) {
  const auto columns = sweep_metrics(kind);
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Metric* metric) { return metric->sweep == column; });
  SIMBENCH_ASSERT(found != columns.end(), "a column of sweep.csv");
  return static_cast<std::size_t>(found - columns.begin());
}

// Joins by commas; NaN is an empty cell.
std::string list_of(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ',';
    if (!std::isnan(values[i])) fmt::format_to(std::back_inserter(text), "{}", values[i]);
  }
  return text;
}

// The numbers of a list with commas; an empty cell is NaN.
std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view cell = text.substr(0, comma);
    const std::optional<double> value = cell.empty() ? kNan : number_in<double>(cell);
    if (!value) return std::nullopt;
    numbers.push_back(*value);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

SweepScore::SweepScore(ResultKind of) : kind(of), values(sweep_metrics(of).size(), 0.0) {}

double& SweepScore::at(std::string_view column) { return values[place_of(column, kind)]; }

SweepScore sweep_score(const Row& row, ResultKind kind) {
  SIMBENCH_ASSERT(row.seeds.size() == 1, "a run has one seed");
  SweepScore score(kind);
  score.values.clear();
  for (const Metric* metric : sweep_metrics(kind)) {
    score.values.push_back(metric->is_series() ? metric->series(row).values.front()
                                               : metric->value(row));
  }
  score.host_errors_ms = row.seeds.front().host_errors_ms;
  if (!row.program_failures.empty()) {
    score.failed = failure_text(row.program_failures.front().failure);
  }
  return score;
}

std::string text_of(const SweepScore& score) {
  return fmt::format("{};{}{}{}", list_of(score.values), list_of(score.host_errors_ms),
                     score.failed.empty() ? "" : ";", score.failed);
}

std::optional<SweepScore> score_of(std::string_view text, ResultKind kind) {
  const std::size_t semicolon = text.find(';');
  if (semicolon == std::string_view::npos) return std::nullopt;
  const auto cells = numbers_of(text.substr(0, semicolon));
  SweepScore score(kind);
  if (!cells || cells->size() != score.values.size()) return std::nullopt;
  score.values = *cells;
  std::string_view hosts = text.substr(semicolon + 1);
  if (const std::size_t end = hosts.find(';'); end != std::string_view::npos) {
    score.failed = hosts.substr(end + 1);
    hosts = hosts.substr(0, end);
  }
  if (hosts.empty()) return score;
  const auto errors = numbers_of(hosts);
  if (!errors) return std::nullopt;
  score.host_errors_ms = *errors;
  return score;
}

namespace {

Series score_series(std::span<const SweepScore> seeds, std::size_t column) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SweepScore& seed : seeds) values.push_back(seed.values[column]);
  return make_series(std::move(values));
}

double sum_of(std::span<const SweepScore> seeds, std::string_view column) {
  const std::size_t place = place_of(column, ResultKind::kCaptures);
  double sum = 0;
  for (const SweepScore& seed : seeds) sum += seed.values[place];
  return sum;
}

std::vector<Series> host_series(std::span<const SweepScore> seeds) {
  std::size_t hosts = 0;
  for (const SweepScore& seed : seeds) hosts = std::max(hosts, seed.host_errors_ms.size());
  std::vector<Series> all;
  for (std::size_t host = 0; host < hosts; ++host) {
    std::vector<double> errors;
    for (const SweepScore& seed : seeds) {
      errors.push_back(host < seed.host_errors_ms.size() ? std::fabs(seed.host_errors_ms[host])
                                                         : kNan);
    }
    all.push_back(make_series(std::move(errors)));
  }
  return all;
}

PooledValues pooled_values(std::span<const SweepScore> seeds, const ResponseRow& row) {
  const double pure = sum_of(seeds, "pure_sets");
  return {.precision = pure / sum_of(seeds, "sets"),
          .recall = pure / sum_of(seeds, "complete_pulses"),
          .margin_ms = row.of("margin_ms").median};
}

}  // namespace

const Series& ResponseRow::of(std::string_view column) const {
  return series[place_of(column, kind)];
}

Series& ResponseRow::at(std::string_view column) { return series[place_of(column, kind)]; }

double ResponseRow::value(const Metric& metric) const {
  const auto* number = std::get_if<double PooledValues::*>(&metric.place);
  return number != nullptr ? pooled.**number : of(metric.sweep).median;
}

std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  SIMBENCH_ASSERT(scores.size() == plan.runs(), "a score for every run");
  const std::size_t columns = sweep_metrics(plan.kind).size();
  std::vector<ResponseRow> rows;
  for (std::size_t first = 0; first < scores.size(); first += plan.seeds) {
    const std::span<const SweepScore> seeds = std::span(scores).subspan(first, plan.seeds);
    const SweepRun run = plan.run(first);
    ResponseRow row{.point = run.point, .pipeline = run.pipeline, .kind = plan.kind};
    for (std::size_t i = 0; i < columns; ++i) row.series.push_back(score_series(seeds, i));
    if (plan.kind == ResultKind::kCaptures) row.pooled = pooled_values(seeds, row);
    row.hosts = host_series(seeds);
    for (const SweepScore& seed : seeds) {
      if (seed.failed.empty()) continue;
      if (row.failed_seeds++ == 0) row.failed = seed.failed;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace simbench::evaluation
