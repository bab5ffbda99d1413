#include "evaluation/sweep/sweep_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

std::size_t place_of(std::string_view column) {
  const auto columns = sweep_metrics();
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Metric* metric) { return metric->sweep == column; });
  SIMBENCH_ASSERT(found != columns.end(), "a column of sweep.csv");
  return static_cast<std::size_t>(found - columns.begin());
}

// With commas; NaN is an empty cell.
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
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!cell.empty()) {
      const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || stop != cell.data() + cell.size()) return std::nullopt;
    }
    numbers.push_back(value);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

SweepScore::SweepScore() : values(sweep_metrics().size(), 0.0) {}

double SweepScore::at(std::string_view column) const { return values[place_of(column)]; }
double& SweepScore::at(std::string_view column) { return values[place_of(column)]; }

SweepScore sweep_score(const Row& row) {
  SIMBENCH_ASSERT(row.seeds.size() == 1, "a run has one seed");
  SweepScore score;
  score.values.clear();
  for (const Metric* metric : sweep_metrics()) {
    score.values.push_back(metric->is_series() ? metric->series(row).values.front()
                                               : metric->value(row));
  }
  score.host_errors_ms = row.seeds.front().host_errors_ms;
  return score;
}

std::string text_of(const SweepScore& score) {
  return fmt::format("{};{}", list_of(score.values), list_of(score.host_errors_ms));
}

std::optional<SweepScore> score_of(std::string_view text) {
  const std::size_t semicolon = text.find(';');
  if (semicolon == std::string_view::npos) return std::nullopt;
  const auto cells = numbers_of(text.substr(0, semicolon));
  SweepScore score;
  if (!cells || cells->size() != score.values.size()) return std::nullopt;
  score.values = *cells;
  const std::string_view hosts = text.substr(semicolon + 1);
  if (hosts.empty()) return score;
  const auto errors = numbers_of(hosts);
  if (!errors) return std::nullopt;
  score.host_errors_ms = *errors;
  return score;
}

std::string_view cells_of(std::string_view text) { return text.substr(0, text.find(';')); }

}  // namespace simbench::evaluation
