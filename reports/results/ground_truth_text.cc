#include "reports/results/ground_truth_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace simbench::reports {
namespace {

using evaluation::GroundTruth;
using evaluation::Results;
using evaluation::Row;

bool has_values(const Row& row) {
  const std::vector<double>& values = row.amd_ms.values;
  return row.frames.delivered > 0 ||
         std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
}

}  // namespace

const char* ground_truth_name(GroundTruth truth) {
  switch (truth) {
    case GroundTruth::kSimulation:
      return "simulation";
    case GroundTruth::kGenlockOrder:
      return "genlock_order";
    case GroundTruth::kNone:
      break;
  }
  return "none";
}

bool is_unverified(const Row& row) {
  return row.ground_truth == GroundTruth::kNone && has_values(row);
}

std::string ground_truth_label(const Row& row) {
  switch (row.ground_truth) {
    case GroundTruth::kSimulation:
      return "simulation";
    case GroundTruth::kGenlockOrder:
      return "GenLock order";
    case GroundTruth::kNone:
      break;
  }
  return is_unverified(row) ? "unverified" : "-";
}

bool has_real_rows(const Results& results) {
  return std::any_of(results.rows.begin(), results.rows.end(),
                     [](const Row& row) { return row.ground_truth != GroundTruth::kSimulation; });
}

std::string shared_worlds(const Results& results) {
  if (has_real_rows(results)) return "Every repetition of a pipeline is a capture of its own.";
  if (!results.draws_load) return "Every pipeline meets the same worlds, one per seed.";
  return fmt::format("Every pipeline meets the same worlds, one per seed, but {}.", kOwnLoad);
}

std::string unverified_legend(const Results& results) {
  if (std::none_of(results.rows.begin(), results.rows.end(), is_unverified)) return "";
  return "unverified: it is unknown which frames belong together, so AMD and RMDV are over the "
         "sets that gathering emitted, and \"pulses scored\" counts these. A gatherer that mixes "
         "neighbours consistently looks perfect there; capture in genlock to verify it.";
}

std::vector<std::string> note_lines(const Results& results) {
  std::vector<std::string> lines;
  for (const Row& row : results.rows) {
    for (const std::string& note : row.notes) {
      lines.push_back(fmt::format("{}, {}", row.pipeline, note));
    }
  }
  return lines;
}

}  // namespace simbench::reports
