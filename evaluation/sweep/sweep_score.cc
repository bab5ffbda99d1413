#include "evaluation/sweep/sweep_score.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

constexpr ScoreColumn kColumns[] = {
    {"amd_ms", &SweepScore::amd_ms},
    {"rmdv_ms", &SweepScore::rmdv_ms},
    {"absolute_error_ms", &SweepScore::absolute_error_ms},
    {"bias_ms", &SweepScore::bias_ms},
    {"host_error_ms", &SweepScore::host_error_ms},
    {"exposure_spread_ms", &SweepScore::exposure_spread_ms},
    {"precision", &SweepScore::precision},
    {"recall", &SweepScore::recall},
    {"margin_ms", &SweepScore::margin_ms},
    {"set_amd_ms", &SweepScore::set_amd_ms},
    {"set_absolute_error_ms", &SweepScore::set_absolute_error_ms},
    {"emission_latency_ms", &SweepScore::emission_latency_ms},
    {"emitted_sets", &SweepScore::emitted_sets},
    {"pure_sets", &SweepScore::pure_sets},
    {"complete_pulses", &SweepScore::complete_pulses},
    {"frames_dropped", &SweepScore::frames_dropped},
    {"unsynchronised_hosts", &SweepScore::unsynchronised_hosts},
};

void append(std::string& text, double value) {
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(text), "{}", value);
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

std::span<const ScoreColumn> score_columns() { return kColumns; }

SweepScore sweep_score(const Row& row) {
  SIMBENCH_ASSERT(row.seeds.size() == 1, "a run has one seed");
  const SeedScore& seed = row.seeds.front();
  return {.amd_ms = seed.amd_ms,
          .rmdv_ms = seed.rmdv_ms,
          .absolute_error_ms = seed.absolute_error_ms,
          .bias_ms = seed.bias_ms,
          .host_error_ms = seed.host_error_ms,
          .exposure_spread_ms = seed.exposure_spread_ms,
          .precision = row.precision,
          .recall = row.recall,
          .margin_ms = row.margin_ms,
          .set_amd_ms = seed.set_amd_ms,
          .set_absolute_error_ms = seed.set_absolute_error_ms,
          .emission_latency_ms = seed.emission_latency_ms,
          .emitted_sets = static_cast<double>(seed.sets.emitted),
          .pure_sets = static_cast<double>(seed.sets.pure),
          .complete_pulses = static_cast<double>(seed.sets.complete_pulses),
          .frames_dropped = static_cast<double>(seed.frames.dropped),
          .unsynchronised_hosts = static_cast<double>(seed.failures.size()),
          .host_errors_ms = seed.host_errors_ms};
}

std::string text_of(const SweepScore& score) {
  std::string text;
  for (const ScoreColumn& column : kColumns) {
    if (&column != kColumns) text += ',';
    append(text, score.*column.member);
  }
  text += ';';
  for (std::size_t host = 0; host < score.host_errors_ms.size(); ++host) {
    if (host > 0) text += ',';
    append(text, score.host_errors_ms[host]);
  }
  return text;
}

std::optional<SweepScore> score_of(std::string_view text) {
  const std::size_t semicolon = text.find(';');
  if (semicolon == std::string_view::npos) return std::nullopt;
  const auto cells = numbers_of(text.substr(0, semicolon));
  if (!cells || cells->size() != std::size(kColumns)) return std::nullopt;
  SweepScore score;
  for (std::size_t i = 0; i < cells->size(); ++i) score.*kColumns[i].member = (*cells)[i];
  const std::string_view hosts = text.substr(semicolon + 1);
  if (hosts.empty()) return score;
  const auto errors = numbers_of(hosts);
  if (!errors) return std::nullopt;
  score.host_errors_ms = *errors;
  return score;
}

std::string_view cells_of(std::string_view text) { return text.substr(0, text.find(';')); }

}  // namespace simbench::evaluation
