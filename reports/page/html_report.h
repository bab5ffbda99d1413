// One self-contained HTML file of one or more result archives: tables, figures, and how to
// reproduce them. It opens offline, in light and dark, and prints.
//
// It begins with the answer (reports/results/results_answer.h), the figures over all pipelines and
// of the error budget, and the summary; then come all tables and the other figures.
//
// The tables are HTML: the blocks that `simbench run` prints (reports/results/results_document.h,
// leaderboard_report.h). The figures are data (reports/page/html_page.h), which the page's
// JavaScript (reports/web/) draws with the embedded uPlot. All text from an archive is escaped.
//
// A report of several archives begins with all of them side by side (reports/page/side_by_side.h).
//
//   const ReportInput input = {.archives = {{.archive = read_archive("results/monday"),
//                                            .figures = figures, .notes = {}}},
//                              .command = {"simbench", "report", "results/monday"}};
//   file << html_report(input);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "reports/page/html_page.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

struct ReportedArchive {
  Archive archive;
  std::vector<Figure> figures{};
  std::vector<std::string> notes{};  // about the figures
  AnswerText answer{};               // empty: none
};

// What a page about several archives begins with: an article of all of them.
struct ReportFront {
  HtmlArticle article;
  std::vector<Figure> figures{};
  std::string title;
  std::string subtitle;
};

struct ReportInput {
  std::vector<ReportedArchive> archives;  // at least one
  std::vector<std::string> command;       // argv of the report
  std::optional<ReportFront> front{};     // nothing: a comparison of the archives, if several
};

std::string html_report(const ReportInput& input);

}  // namespace simbench::reports
