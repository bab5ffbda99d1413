#include "reports/page/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/comparison/comparison.h"
#include "reports/figures/comparison_figures.h"
#include "reports/page/compare_page.h"
#include "reports/results/ground_truth_text.h"
#include "reports/text/time_text.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using evaluation::Row;
using evaluation::Series;

std::string cell_of(const Archive& archive, const std::string& pipeline, Series Row::*series) {
  const Row* const row = evaluation::find_row(archive.results.rows, pipeline);
  if (row == nullptr || std::isnan(((*row).*series).median)) return "-";
  const Series& values = (*row).*series;
  return fmt::format("{} {}{}", time_text(values.median), time_band_text(values.p05, values.p95),
                     is_unverified(*row) ? " (unverified)" : "");
}

// The pipelines of all archives, in order.
std::vector<std::string> pipelines_of(const std::vector<ReportedArchive>& archives) {
  std::vector<std::string> pipelines;
  for (const ReportedArchive& reported : archives) {
    for (const Row& row : reported.archive.results.rows) {
      if (std::find(pipelines.begin(), pipelines.end(), row.pipeline) == pipelines.end()) {
        pipelines.push_back(row.pipeline);
      }
    }
  }
  return pipelines;
}

Block archive_block(const std::vector<ReportedArchive>& archives) {
  std::vector<Field<std::string>> fields = {
      {{"pipeline", Align::kLeft}, [](const std::string& pipeline) { return pipeline; }}};
  const auto add = [&fields](const Archive& archive, const char* what, Series Row::*series) {
    fields.push_back({{fmt::format("{}: {}", archive.path, what)},
                      [&archive, series](const std::string& pipeline) {
                        return cell_of(archive, pipeline, series);
                      }});
  };
  for (const ReportedArchive& reported : archives) {
    add(reported.archive, "AMD", &Row::amd_ms);
    add(reported.archive, "absolute error", &Row::absolute_error_ms);
  }
  return {.heading = "The archives side by side",
          .table = table_of(fields, pipelines_of(archives)),
          .prose = {"Median over the seeds with the band from 5 to 95 %."}};
}

// The reason if they cannot be compared.
std::string compare_into(const Archive& first, const Archive& other,
                         const std::vector<std::string>& command, SideBySide& parts) {
  try {
    const Comparison comparison = compare_archives(first, other, {});
    parts.articles.push_back(comparison_article(comparison, command));
    parts.data.push_back(figures_json(comparison_figures(comparison)));
    return "";
  } catch (const scenarios::InputError& error) {
    return fmt::format("Not compared seed by seed: {}.", error.what());
  }
}

}  // namespace

SideBySide archives_side_by_side(const std::vector<ReportedArchive>& archives,
                                 const std::vector<std::string>& command) {
  if (archives.size() < 2) return {};
  SideBySide parts;
  Block together = archive_block(archives);
  for (std::size_t i = 1; i < archives.size(); ++i) {
    const std::string reason =
        compare_into(archives.front().archive, archives[i].archive, command, parts);
    if (!reason.empty()) together.prose.push_back(reason);
  }
  (parts.articles.empty() ? parts.above : parts.articles.front().summary) = html(together);
  return parts;
}

}  // namespace simbench::reports
