#include "reports/page/html_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/text/html_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Results;
using evaluation::Row;

const Row* row_of(const Results& results, const std::string& pipeline) {
  const auto row = std::find_if(results.rows.begin(), results.rows.end(),
                                [&](const Row& each) { return each.pipeline == pipeline; });
  return row == results.rows.end() ? nullptr : &*row;
}

std::string with_band(const evaluation::Series& series) {
  if (std::isnan(series.median)) return "-";
  return fmt::format("{} {}", number_text(series.median), band_text(series));
}

// Of all archives, in the order in which they come.
std::vector<std::string> pipelines_of(const std::vector<const Archive*>& archives) {
  std::vector<std::string> pipelines;
  for (const Archive* archive : archives) {
    for (const Row& row : archive->results.rows) {
      if (std::find(pipelines.begin(), pipelines.end(), row.pipeline) == pipelines.end()) {
        pipelines.push_back(row.pipeline);
      }
    }
  }
  return pipelines;
}

}  // namespace

std::string html_comparison(const std::vector<const Archive*>& archives) {
  if (archives.size() < 2) return "";
  std::vector<HtmlTable::Column> columns = {{"pipeline", HtmlTable::Align::kLeft}};
  for (const Archive* archive : archives) {
    columns.push_back({fmt::format("{}: AMD, ms", archive->path)});
    columns.push_back({fmt::format("{}: absolute error, ms", archive->path)});
  }
  HtmlTable table("The archives side by side", columns);
  for (const std::string& pipeline : pipelines_of(archives)) {
    std::vector<std::string> cells = {pipeline};
    for (const Archive* archive : archives) {
      const Row* row = row_of(archive->results, pipeline);
      cells.push_back(row ? with_band(row->amd_ms) : "-");
      cells.push_back(row ? with_band(row->absolute_error_ms) : "-");
    }
    table.add(cells);
  }
  return fmt::format(
      "<section>\n<h3>The archives side by side</h3>\n{}<p class=\"legend\">Median over the seeds "
      "with the band from 5 to 95 %. Whether a difference is more than chance: simbench "
      "compare.</p>\n</section>\n",
      table.html());
}

}  // namespace simbench::reports
