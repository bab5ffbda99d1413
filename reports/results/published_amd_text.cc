#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "recording/counted.h"
#include "reports/results/results_document.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Placement;
using evaluation::Results;
using evaluation::Row;

// "yoon2021_both at 25 % [11-43], ..." of the rows whose published AMD is placed so.
std::string placed_rows(const Results& results, Placement placement) {
  std::vector<std::string> texts;
  for (const Row& row : results.rows) {
    if (!row.published) continue;
    const evaluation::Percentile& percentile = row.published->amd_percentile;
    if (evaluation::placement_of(percentile) != placement) continue;
    texts.push_back(fmt::format("{} at {}", row.pipeline, percentile_text(percentile)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace

std::string published_amd_text(const Results& results) {
  const PublishedAmdCount count = published_amd_count(results);
  if (count.all == 0) return "";
  std::vector<std::string> parts;
  const std::string inside = placed_rows(results, Placement::kInside);
  parts.push_back(fmt::format("{} of {} inside{}", count.inside, count.all,
                              inside.empty() ? "" : fmt::format(" ({})", inside)));
  const std::string outside = placed_rows(results, Placement::kOutside);
  if (!outside.empty()) parts.push_back("outside: " + outside);
  const std::string unknown = placed_rows(results, Placement::kTooFewSeeds);
  if (!unknown.empty()) {
    parts.push_back(
        fmt::format("{} cannot place {}", counted(results.seed_count, "seed"), unknown));
  }
  return fmt::format("Published AMD, by its percentile [95 % interval]: {}.",
                     fmt::join(parts, "; "));
}

PublishedAmdCount published_amd_count(const Results& results) {
  PublishedAmdCount count;
  for (const Row& row : results.rows) {
    if (!row.published) continue;
    ++count.all;
    switch (evaluation::placement_of(row.published->amd_percentile)) {
      case Placement::kInside:
        ++count.inside;
        break;
      case Placement::kOutside:
        ++count.outside;
        break;
      case Placement::kTooFewSeeds:
        break;
    }
  }
  return count;
}

}  // namespace simbench::reports
