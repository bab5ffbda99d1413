#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "reports/results/results_document.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::FigureComparison;
using evaluation::FigureVerdict;
using evaluation::Metric;
using evaluation::Results;

const Metric& metric_of(const FigureComparison& compared) {
  return evaluation::metric(compared.figure.metric);
}

std::string figure_verdict_text(FigureVerdict verdict) {
  const std::string_view word = evaluation::verdict_word(verdict);
  return std::string(word.empty() ? "too few seeds" : word);
}

// "at most 0.250 ms".
std::string figure_text(const FigureComparison& compared) {
  const scenarios::PublishedFigure& figure = compared.figure;
  std::string number = metric_text(metric_of(compared), figure.number());
  if (figure.value) return number;
  return fmt::format("{} {}", figure.at_most ? "at most" : "at least", number);
}

// The values of the row, which there is.
const evaluation::Series& simulated(const Results& results, const FigureComparison& compared) {
  return metric_of(compared).series(*find_row(results.rows, compared.figure.pipeline));
}

std::string band_of_figure(const Results& results, const FigureComparison& compared) {
  const evaluation::Series& series = simulated(results, compared);
  return interval_text(metric_of(compared), series.p05, series.p95);
}

std::string median_of_figure(const Results& results, const FigureComparison& compared) {
  return metric_text(metric_of(compared), simulated(results, compared).median);
}

std::string figures_legend() {
  return fmt::format(
      "Of a value, {} Of a bound, holds: the whole interval of the share of the seeds "
      "that keep it lies from 95 % on; inside: between 5 and 95 %; fails: below 5 %; too few "
      "seeds: "
      "none of these (holds takes {} seeds). A world that resembles the published one is not it.",
      placement_legend(), evaluation::kFewestOutside);
}

Table figures_table(const Results& results) {
  const std::vector<Field<FigureComparison>> fields = {
      {{"pipeline", Align::kLeft}, [](const auto& compared) { return compared.figure.pipeline; }},
      {{"metric", Align::kLeft},
       [](const auto& compared) { return std::string(metric_of(compared).title); }},
      {{"published"}, figure_text},
      {{"simulated\nmedian"},
       [&results](const auto& compared) { return median_of_figure(results, compared); }},
      {{"simulated\n5-95 %"},
       [&results](const auto& compared) { return band_of_figure(results, compared); }},
      {{"at percentile\n[95 % interval]"},
       [](const auto& compared) { return percentile_text(compared.percentile); }},
      {{.header = "published\nis", .align = Align::kLeft, .is_verdict = true},
       [](const auto& compared) { return figure_verdict_text(compared.verdict); }},
      {{"source", Align::kLeft}, [](const auto& compared) { return compared.figure.source; }}};
  return table_of(fields, results.published_figures);
}

}  // namespace

std::optional<Block> published_figures_block(const Results& results) {
  if (results.published_figures.empty()) return std::nullopt;
  Block block{
      .heading = "Published figures", .table = figures_table(results), .prose = {figures_legend()}};
  for (const FigureComparison& compared : results.published_figures) {
    block.items.push_back(fmt::format("{}, {} {}: {}", compared.figure.pipeline,
                                      metric_of(compared).title, figure_text(compared),
                                      compared.figure.conditions));
  }
  return block;
}

std::optional<Block> published_figures_lines(const Results& results) {
  if (results.published_figures.empty()) return std::nullopt;
  Block block{.heading = "Published figures"};
  for (const FigureComparison& compared : results.published_figures) {
    block.items.push_back(
        fmt::format("{}, {}: published {}, simulated {} {}, at percentile {}: {} ({})",
                    compared.figure.pipeline, metric_of(compared).title, figure_text(compared),
                    median_of_figure(results, compared), band_of_figure(results, compared),
                    percentile_text(compared.percentile), figure_verdict_text(compared.verdict),
                    compared.figure.source));
  }
  return block;
}

}  // namespace simbench::reports
