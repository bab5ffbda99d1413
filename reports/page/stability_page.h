// The stability of measured clocks as one self-contained HTML file (`simbench stability --html`):
// the verdict of the limits, the time error, ADEV, TDEV and MTIE with their intervals, the tables.
//
//   file << stability_html({.command = {"simbench", "stability", "ptp4l.log"}});
#pragma once

#include <string>
#include <vector>

#include "evaluation/stability/masks.h"
#include "reports/stability/stability_report.h"

namespace simbench::reports {

struct StabilityPage {
  std::vector<StabilityFinding> findings{};
  std::vector<evaluation::ClockMask> masks{};  // that they were judged by
  std::vector<std::string> command{};          // argv of what makes the page
};

std::string stability_html(const StabilityPage& page);

}  // namespace simbench::reports
