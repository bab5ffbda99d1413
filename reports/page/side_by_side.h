// What a report of several archives begins with: their medians in one table, and the comparison of
// the first with each other one, seed by seed (reports/page/compare_page.h).
//
// Archives that cannot be paired, of other worlds or without a common seed, are in the table alone,
// and a paragraph has the reason.
//
//   const std::vector<ReportedArchive> archives = {{.archive = read_archive("monday")}};
//   const SideBySide parts = archives_side_by_side(archives, {"simbench", "report", "monday"});
#pragma once

#include <string>
#include <vector>

#include "reports/page/html_page.h"
#include "reports/page/html_report.h"

namespace simbench::reports {

// Nothing of a single archive.
struct SideBySide {
  std::string above{};                  // HTML in front of all articles; of pairs the first has it
  std::vector<HtmlArticle> articles{};  // one for each pair, without their numbers
  std::vector<std::string> data{};      // figures_json() of each
};

SideBySide archives_side_by_side(const std::vector<ReportedArchive>& archives,
                                 const std::vector<std::string>& command);

}  // namespace simbench::reports
