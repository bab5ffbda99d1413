#include "reports/recordings/stack_study.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numeric>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"
#include "recording/version.h"
#include "reports/text/output_file.h"

namespace simbench::reports {
namespace {

using StudyJson = nlohmann::ordered_json;

constexpr int kStackStudyVersion = 1;
constexpr const char* kAbout =
    "Datagrams of 48 bytes between two network namespaces of one machine, 5 to 15 ms apart, with "
    "the kernel's software stamps. transmit: from the send call to the transmit stamp; passage: "
    "from there to the receive stamp, through a veth pair, so without card and interrupt; wake_up: "
    "from there until the receive call returns after poll. quantiles_us: of the shortest 99.5 %, "
    "at "
    "equally spaced probabilities; the longest 0.5 % are spikes.";

double in_hundredths(double us) { return std::round(us * 100) / 100; }

// Ranks of the values; equal ones in the order of their places.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<double>(i);
  return ranks;
}

double rank_correlation_with_next(const std::vector<double>& values) {
  const std::vector<double> ranks = ranks_of(values);
  const double mean = evaluation::mean_of(ranks);
  double squares = 0;
  double products = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    squares += (ranks[i] - mean) * (ranks[i] - mean);
    if (i > 0) products += (ranks[i] - mean) * (ranks[i - 1] - mean);
  }
  return products / squares;
}

StudyJson law_json(const StackLaw& law) {
  StudyJson quantiles = StudyJson::array();
  for (const double each : law.quantiles_us) quantiles.push_back(in_hundredths(each));
  return {{"messages", law.messages},
          {"quantiles_us", std::move(quantiles)},
          {"spike_probability", law.spike_probability},
          {"spike_max_us", in_hundredths(law.spike_max_us)},
          {"mean_us", in_hundredths(law.mean_us)},
          {"longest_us", in_hundredths(law.longest_us)},
          {"correlation_with_next", in_hundredths(law.correlation_with_next)}};
}

}  // namespace

StackLaw stack_law(const std::vector<double>& delays_us) {
  SIMBENCH_ASSERT(delays_us.size() >= kStackQuantiles, "a table needs as many delays");
  std::vector<double> sorted = delays_us;
  std::sort(sorted.begin(), sorted.end());
  StackLaw law{.messages = sorted.size(),
               .quantiles_us = {},
               .mean_us = evaluation::mean_of(sorted),
               .longest_us = sorted.back(),
               .correlation_with_next = rank_correlation_with_next(delays_us)};
  const auto spikes = static_cast<std::size_t>(static_cast<double>(sorted.size()) * kSpikeShare);
  const std::vector<double> longest(sorted.end() - static_cast<std::ptrdiff_t>(spikes),
                                    sorted.end());
  sorted.resize(sorted.size() - spikes);
  law.quantiles_us.reserve(kStackQuantiles);
  for (std::size_t i = 0; i < kStackQuantiles; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kStackQuantiles - 1);
    law.quantiles_us.push_back(evaluation::quantile_of_sorted(sorted, share));
  }
  if (spikes == 0) return law;
  // Spikes come on top of the table, which is linear between the quantiles.
  const double ends = (law.quantiles_us.front() + law.quantiles_us.back()) / 2;
  const double sum = std::accumulate(law.quantiles_us.begin(), law.quantiles_us.end(), 0.0);
  const double table_mean = (sum - ends) / static_cast<double>(kStackQuantiles - 1);
  law.spike_probability = kSpikeShare;
  law.spike_max_us = 2 * (evaluation::mean_of(longest) - table_mean);
  return law;
}

std::string stack_study_json(const StackStudy& study) {
  StudyJson root = {{"schema_version", kStackStudyVersion},
                    {"about", kAbout},
                    {"date", study.date},
                    {"machine", study.machine},
                    {"commit", std::string(commit())},
                    {"conditions", StudyJson::array()}};
  for (const StackCondition& each : study.conditions) {
    StudyJson condition = {{"name", each.name}, {"busy_threads", each.busy_threads}};
    for (const StackPart& part : each.parts) condition[part.name] = law_json(part.law);
    root["conditions"].push_back(std::move(condition));
  }
  return root.dump(1, ' ', false, StudyJson::error_handler_t::replace) + "\n";
}

void write_stack_study(const std::string& path, const StackStudy& study) {
  write_file(path, stack_study_json(study));
}

}  // namespace simbench::reports
