// What a report shows of an archive: figures and notes, within bounds of time and size.
#ifndef SIMBENCH_APP_REPORT_FIGURES_H_
#define SIMBENCH_APP_REPORT_FIGURES_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "reports/page/html_report.h"

namespace simbench::app {

struct ReportDetail {
  // How many seeds, from the first; nothing: kDefaultSeeds, fewer where there are many pipelines.
  std::optional<std::uint64_t> seeds{};
  std::optional<std::uint64_t> budget_seeds{};  // likewise; 0: no error budgets
  std::vector<std::string> pipelines{};         // empty: all of the archive
};

inline constexpr std::uint64_t kDefaultSeeds = 4;
// Runs (pipeline and seed) that a report shows in detail, if nobody asks for another number of
// seeds: about 3 MB of figures of 18 cameras.
inline constexpr std::uint64_t kMostRuns = 32;

// The same with every choice made, for one of `archives` that share the bounds.
ReportDetail bounded(const ReportDetail& detail, const reports::Archive& archive,
                     std::size_t archives);

// `detail` as bounded() gives it. Progress counts runs. What cannot be drawn (no manifest, a
// scenario that this version does not take) is left out, and a note says so.
reports::ReportedArchive with_figures(reports::Archive archive, const ReportDetail& detail,
                                      const evaluation::Progress& progress);

// Of what not everything is shown; empty if it is.
std::string detail_note(const reports::Archive& archive, const ReportDetail& detail);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_REPORT_FIGURES_H_
