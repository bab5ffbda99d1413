// A reconstruction experiment as one self-contained HTML file (reports/page/html_page.h): Table 4,
// the painted meshes side by side as in the paper's Figure 1, the curve, how to reproduce it.
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_HTML_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_HTML_H_

#include <string>
#include <vector>

#include "reconstruction/results.h"

namespace simbench::reports {

struct ReconstructionPicture {
  std::string pipeline;
  std::string png;  // the bytes of the file
  double desync_ms = 0;
  reconstruction::ErrorSummary errors;  // of the one set that is shown
};

struct ReconstructionPage {
  const reconstruction::ReconstructionResults& results;
  const std::vector<ReconstructionPicture>& pictures;  // in any order
  std::vector<std::string> command;                    // that made it, argv
};

std::string reconstruction_html(const ReconstructionPage& page);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_HTML_H_
