#include "reports/page/stability_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "recording/collected.h"
#include "reports/archive/archive.h"
#include "reports/figures/stability_figure.h"
#include "reports/page/html_page.h"

namespace simbench::reports {
namespace {

// What limits say is the answer of who gave some; the largest time error then explains it.
AnswerText verdict_first(AnswerText answer) {
  const auto limits = std::ranges::find(answer.points, "Limits", &AnswerPoint::label);
  if (limits == answer.points.end()) return answer;
  std::swap(answer.lead, limits->text);
  limits->label = "Time error";
  return answer;
}

// The page draws no bands: their edges are points, which share an entry of the legend.
void draw_intervals(Figure& figure) {
  for (FigurePanel& panel : figure.panels) {
    std::vector<FigureSeries> edges;
    for (const FigureSeries& series : panel.series) {
      for (const std::vector<double>& edge : {series.low, series.high}) {
        if (edge.empty()) continue;
        edges.push_back({.label = series.label + ", 95 %",
                         .mark = Mark::kPoints,
                         .x = series.x,
                         .y = edge,
                         .colour = series.colour});
      }
    }
    std::ranges::move(edges, std::back_inserter(panel.series));
  }
}

}  // namespace

std::string stability_html(const StabilityPage& page) {
  const std::string names = fmt::format(
      "{}",
      fmt::join(collected(page.findings, [](const auto& of) { return log_name(of.log); }), ", "));
  Figure curves = stability_figure(page.findings, page.masks);
  draw_intervals(curves);
  const Figure errors = time_error_figure(page.findings, page.masks);
  std::vector<std::string> notes;
  for (const StabilityFinding& finding : page.findings) {
    notes.insert(notes.end(), finding.log.notes.begin(), finding.log.notes.end());
  }
  const HtmlArticle article = {
      .name = names,
      .heading = names,
      .answer = verdict_first(stability_answer(page.findings)),
      .lead_figures = {errors.id, curves.id},
      .about = html_notes(notes),
      .body = html(stability_document(page.findings).blocks),
      .reproduce =
          fmt::format("<dl>\n{}</dl>\n", html_command("All of this", simbench_line(page.command)))};
  return html_page({.title = fmt::format("simbench stability {}", names),
                    .subtitle = "how stable these measured clocks are",
                    .main = html_article(article),
                    .data = {figures_json({errors, curves})}});
}

}  // namespace simbench::reports
