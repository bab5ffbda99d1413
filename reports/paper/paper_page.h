// The page of `simbench paper`: first the paper, with its tables, claims and figures beside what is
// printed, then the result archive of each rate as a report has it.
//
//   PaperResults measured;                  // of app::run_paper()
//   std::vector<ReportedArchive> archives;  // of both rates
//   const std::string page = paper_html({measured, archives, {"simbench", "paper"}});
#pragma once

#include <string>
#include <vector>

#include "reports/page/html_report.h"
#include "reports/paper/paper_document.h"

namespace simbench::reports {

struct PaperPage {
  const PaperResults& results;
  std::vector<ReportedArchive> archives;  // of both rates
  std::vector<std::string> command;       // argv
};

std::string paper_html(PaperPage page);

}  // namespace simbench::reports
