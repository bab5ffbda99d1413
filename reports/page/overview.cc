#include "reports/page/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "reports/results/results_answer.h"
#include "reports/text/escaped_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::RankedBy;
using evaluation::Results;
using evaluation::Row;
using evaluation::Series;

constexpr std::size_t kMostOverviewRows = 24;
constexpr const char* kBest = "best";

// Whole decades around all that is drawn.
struct LogAxis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double ms) {
    if (!(ms > 0)) return;
    low = std::min(low, std::floor(std::log10(ms)));
    high = std::max(high, std::ceil(std::log10(ms)));
  }
  void widen() {
    if (high == low) high += 1;
  }
  // In percent of the axis.
  double at(double ms) const {
    return ms > 0 ? std::clamp(100 * (std::log10(ms) - low) / (high - low), 0.0, 100.0) : 0;
  }
};

// A name that may break behind its underscores and nowhere else.
std::string breakable(const std::string& name) {
  std::string text;
  for (const char c : html_escaped(name)) {
    text += c;
    if (c == '_') text += "<wbr>";
  }
  return text;
}

std::string row_html(const OverviewRow& row, const LogAxis& axis) {
  const Series& series = *row.series;
  const char* const style = row.word == kBest ? "best" : row.word.empty() ? "" : "limit";
  const double from = axis.at(series.p05);
  std::string marks = fmt::format(
      "<i class=\"band\" style=\"left:{:.2f}%;width:{:.2f}%\"></i>"
      "<i class=\"dot\" style=\"left:{:.2f}%\"></i>",
      from, std::max(axis.at(series.p95) - from, 0.2), axis.at(series.median));
  if (row.published_ms) {
    marks +=
        fmt::format("<i class=\"published\" style=\"left:{:.2f}%\" title=\"published: {}\"></i>",
                    axis.at(*row.published_ms), time_text(*row.published_ms));
  }
  return fmt::format(
      "<tr class=\"{}\"><th scope=\"row\">{}{}</th><td class=\"track\">{}</td><td>{}</td></tr>\n",
      style, breakable(row.row->pipeline),
      row.word.empty() ? "" : fmt::format(" <small>{}</small>", row.word), marks,
      time_text(series.median));
}

std::string axis_html(const LogAxis& axis) {
  std::string ticks;
  for (double decade = axis.low; decade <= axis.high; ++decade) {
    const double ms = std::pow(10.0, decade);
    ticks += fmt::format("<span style=\"left:{:.2f}%\">{}</span>", axis.at(ms), tick_text(ms));
  }
  return fmt::format("<tr class=\"axis\"><td></td><td class=\"track\">{}</td><td></td></tr>\n",
                     ticks);
}

// The published value of the metric that ranks; nothing if there is none.
std::optional<double> published_of(const Results& results, const Row& row, RankedBy ranked_by) {
  if (ranked_by == RankedBy::kAmd && row.published && row.published->amd_ms > 0) {
    return row.published->amd_ms;
  }
  const Series* const ranked = &evaluation::ranked_series(row, ranked_by);
  for (const evaluation::FigureComparison& compared : results.published_figures) {
    const scenarios::PublishedFigure& figure = compared.figure;
    const bool is_of_it = figure.pipeline == row.pipeline && figure.number() > 0 &&
                          &evaluation::metric(figure.metric).series(row) == ranked;
    if (is_of_it) return figure.number();
  }
  return std::nullopt;
}

}  // namespace

std::vector<OverviewRow> overview_rows(const Results& results) {
  const RankedBy ranked_by = evaluation::ranking_of(results);
  std::vector<const Row*> drawn;
  std::vector<OverviewRow> rows;
  for (const Row& row : results.rows) {
    if (evaluation::ranked_series(row, ranked_by).median > 0) drawn.push_back(&row);
  }
  std::ranges::stable_sort(drawn, {}, [ranked_by](const Row* row) {
    return evaluation::ranked_series(*row, ranked_by).median;
  });
  const Row* const best = evaluation::best_of(drawn, ranked_by);
  rows.reserve(drawn.size());
  for (const Row* row : drawn) {
    OverviewRow line{.row = row,
                     .series = &evaluation::ranked_series(*row, ranked_by),
                     .published_ms = published_of(results, *row, ranked_by)};
    line.word = row == best
                    ? kBest
                    : evaluation::standing_name(evaluation::standing_of(*row, ranked_by).is);
    rows.push_back(std::move(line));
  }
  return rows;
}

std::string overview_html(const Results& results) {
  std::vector<OverviewRow> rows = overview_rows(results);
  if (rows.empty()) return "";
  const std::size_t all = rows.size();
  rows.resize(std::min(rows.size(), kMostOverviewRows));
  LogAxis axis;
  bool any_published = false;
  for (const OverviewRow& row : rows) {
    for (const double ms : {row.series->p05, row.series->median, row.series->p95}) axis.include(ms);
    if (!row.published_ms) continue;
    axis.include(*row.published_ms);
    any_published = true;
  }
  axis.widen();
  std::string body;
  for (const OverviewRow& row : rows) body += row_html(row, axis);
  const std::string what =
      capitalised(evaluation::ranked_metric(evaluation::ranking_of(results)).title);
  return fmt::format(
      "<figure class=\"overview\"><table><caption>{} of each pipeline</caption>\n<tbody>\n"
      "{}{}</tbody></table>\n<figcaption>{}: median (dot) and band from 5 to 95 % over the seeds, "
      "on a logarithmic axis.{}{}</figcaption></figure>\n",
      what, body, axis_html(axis), what, any_published ? " Diamonds: published values." : "",
      all > rows.size() ? fmt::format(" The first {} of {}.", rows.size(), all) : "");
}

}  // namespace simbench::reports
