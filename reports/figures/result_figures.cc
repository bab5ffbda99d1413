#include "reports/figures/result_figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "evaluation/budget/pipeline_budget.h"
#include "evaluation/scoring/rows.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "reports/figures/figure_parts.h"
#include "reports/results/metric_columns.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Budget;
using evaluation::BudgetPart;
using evaluation::ErrorParts;
using evaluation::HostClockBudget;
using evaluation::PipelineBudget;
using evaluation::PulseScore;
using Published = evaluation::PublishedComparison;
using evaluation::Results;
using evaluation::Row;
using evaluation::SeedScore;

constexpr std::array<std::string_view, 4> kPaperRows = {"ntp_last_set", "yoon2021_network",
                                                        "yoon2021_time", "yoon2021_both"};
constexpr std::size_t kMostTogether = 12;  // more curves in one panel cannot be told apart

struct RowRef {
  const Row* row = nullptr;
  int colour = 0;
};

// The paper's rows, or the first ones, each with its colour in all figures.
std::vector<RowRef> four_rows(const Results& results) {
  std::vector<RowRef> rows;
  for (const std::string_view name : kPaperRows) {
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
      if (results.rows[i].pipeline == name) rows.push_back({&results.rows[i], static_cast<int>(i)});
    }
  }
  if (!rows.empty()) return rows;
  for (std::size_t i = 0; i < std::min(results.rows.size(), kPaperRows.size()); ++i) {
    rows.push_back({&results.rows[i], static_cast<int>(i)});
  }
  return rows;
}

// States which of the paper's rows there are not.
void note_missing(const Results& results, Figure& figure) {
  std::vector<std::string_view> missing;
  for (const std::string_view name : kPaperRows) {
    if (evaluation::find_row(results.rows, std::string(name)) == nullptr) missing.push_back(name);
  }
  if (missing.empty()) return;
  add_lack(figure,
           {.what = fmt::format("{}", fmt::join(missing, ", ")), .scenario = "18cam_6host_45fps"});
}

std::vector<RowRef> first_rows(const Results& results) {
  std::vector<RowRef> rows;
  for (std::size_t i = 0; i < std::min(results.rows.size(), kMostTogether); ++i) {
    rows.push_back({&results.rows[i], static_cast<int>(i)});
  }
  return rows;
}

const SeedScore* seed_of(const Row& row, std::uint64_t seed) {
  const auto found = std::find_if(row.seeds.begin(), row.seeds.end(),
                                  [seed](const SeedScore& score) { return score.seed == seed; });
  return found == row.seeds.end() ? nullptr : &*found;
}

bool empty(const FigurePanel& panel) {
  return std::all_of(panel.series.begin(), panel.series.end(),
                     [](const FigureSeries& series) { return series.x.empty(); });
}

void add_published(const std::vector<RowRef>& rows, double Published::*metric, FigurePanel& panel) {
  for (const RowRef& ref : rows) {
    if (!ref.row->published) continue;
    const double value = (*ref.row->published).*metric;
    panel.lines.push_back({.label = rows.size() == 1
                                        ? fmt::format("published: {}", number_text(value))
                                        : fmt::format("{}, published", ref.row->pipeline),
                           .at = value,
                           .colour = ref.colour});
  }
}

FigurePanel pulse_panel(const std::vector<RowRef>& rows, std::uint64_t seed, std::string title,
                        std::string axis, double PulseScore::*value) {
  FigurePanel made = panel(std::move(title), "pulse", std::move(axis));
  made.x_is_pulse = true;
  for (const RowRef& ref : rows) {
    const SeedScore* score = seed_of(*ref.row, seed);
    if (score == nullptr || score->pulses.empty() || evaluation::has_single_camera(*ref.row)) {
      continue;
    }
    FigureSeries curve = series(ref.row->pipeline, Mark::kLine, ref.colour);
    for (const PulseScore& pulse : score->pulses) {
      curve.add(static_cast<double>(pulse.pulse), pulse.*value);
    }
    made.series.push_back(thinned(std::move(curve), kMostPoints));
  }
  choose_scale(made);
  return made;
}

// Which pipeline's AMD changes most along the recording, by its least-squares line. The paper sees
// no such change.
std::string trend_text(const std::vector<RowRef>& rows, std::uint64_t seed) {
  double largest = 0;
  std::string pipeline;
  for (const RowRef& ref : rows) {
    const SeedScore* score = seed_of(*ref.row, seed);
    if (score == nullptr || score->pulses.size() < 2) continue;
    std::vector<double> at;
    std::vector<double> spreads;
    for (const PulseScore& pulse : score->pulses) {
      at.push_back(static_cast<double>(pulse.pulse));
      spreads.push_back(pulse.spread_ms);
    }
    const evaluation::FittedLine line = evaluation::fit_line(at, spreads);
    const double change = line.slope * (at.back() - at.front()) / line.mean_y;
    if (!(std::abs(change) > std::abs(largest))) continue;
    largest = change;
    pipeline = ref.row->pipeline;
  }
  if (pipeline.empty()) return "";
  return fmt::format(
      " Over the recording the AMD of {} changes most along its least-squares line, by {:+.1f} % "
      "of its mean.",
      pipeline, largest * 100);
}

// A metric's quantiles over seeds, as the tables have them (evaluation/statistics/statistics.h).
FigurePanel quantile_panel(const std::vector<RowRef>& rows, const evaluation::Metric& metric) {
  FigurePanel made = panel(capitalised(metric.title), "share of seeds (%)",
                           fmt::format("{} ({})", metric.title, metric.unit));
  for (const RowRef& ref : rows) {
    auto curve = quantile_curve(metric.series(*ref.row).values, ref.row->pipeline, ref.colour);
    if (curve) made.series.push_back(std::move(*curve));
  }
  choose_scale(made);
  if (metric.id == std::string_view("amd_ms")) add_published(rows, &Published::amd_ms, made);
  if (metric.id == std::string_view("rmdv_ms")) add_published(rows, &Published::rmdv_ms, made);
  return made;
}

Figure distribution(const std::vector<RowRef>& rows, const Results& results) {
  Figure figure = catalogued("distributions");
  for (const evaluation::Metric& metric : evaluation::metrics()) {
    if (column_of(metric).band_heading == nullptr) continue;
    FigurePanel made = quantile_panel(rows, metric);
    if (!empty(made)) figure.panels.push_back(std::move(made));
  }
  if (figure.panels.empty()) return absent(std::move(figure), "No seed has any of these scores.");
  figure.caption = fmt::format(
      "Scores of {} in ascending order: the curve at 50 % is the median of the tables, at 5 and 95 "
      "% the band. A line is a published value, which is one recording.",
      counted(results.seed_count, "seed"));
  const auto lacks_seeds = [&results](const RowRef& ref) {
    return evaluation::scored_seeds(*ref.row) < results.seed_count;
  };
  if (std::any_of(rows.begin(), rows.end(), lacks_seeds)) {
    figure.caption += " Not every seed has a score of every pipeline: see the tables.";
  }
  if (std::any_of(figure.panels.begin(), figure.panels.end(),
                  [](const FigurePanel& made) { return made.log_y; })) {
    figure.caption += kLogNote;
  }
  return figure;
}

// Median over seeds of |error| by host; and of one pipeline also the seeds themselves, signed.
Figure order_figure(const std::vector<RowRef>& rows) {
  Figure figure = catalogued("host_order");
  FigurePanel medians =
      panel("Median over seeds", "host, in order of synchronisation", "|mean error| (ms)");
  FigurePanel single = panel("Every seed", medians.x_label, "mean error (ms)");
  for (const RowRef& ref : rows) {
    std::vector<std::vector<double>> by_host;
    FigureSeries points = series(ref.row->pipeline, Mark::kPoints, ref.colour);
    for (const SeedScore& seed : ref.row->seeds) {
      by_host.resize(std::max(by_host.size(), seed.host_errors_ms.size()));
      for (std::size_t host = 1; host < seed.host_errors_ms.size(); ++host) {
        const double error = seed.host_errors_ms[host];
        if (std::isnan(error)) continue;
        by_host[host].push_back(std::abs(error));
        points.add(static_cast<double>(host), error);
      }
    }
    FigureSeries curve = series(ref.row->pipeline, Mark::kLine, ref.colour);
    for (std::size_t host = 1; host < by_host.size(); ++host) {
      if (by_host[host].empty()) continue;
      curve.add(static_cast<double>(host), evaluation::median(by_host[host]));
    }
    if (curve.x.empty()) continue;
    medians.series.push_back(thinned(std::move(curve), kMostPoints));
    if (rows.size() == 1) single.series.push_back(thinned(std::move(points), kMostPoints));
  }
  if (medians.series.empty()) {
    return absent(std::move(figure),
                  "There is no slave host, or no errors of host clocks were recorded, which only a "
                  "simulated world knows; `simbench run --scenario SCENARIO --output DIR` keeps "
                  "them.");
  }
  choose_scale(medians);
  const bool is_log = medians.log_y;
  figure.panels.push_back(std::move(medians));
  if (!single.series.empty()) figure.panels.push_back(std::move(single));
  figure.caption =
      "System clock of each slave minus the master's, mean over the evaluated pulses. The paper's "
      "procedure synchronises the hosts one after another, in this order.";
  if (rows.size() == 1 && figure.panels.front().series.front().y.size() > 1) {
    const std::vector<double>& medians_ms = figure.panels.front().series.front().y;
    figure.caption += fmt::format(" From the first slave to the last the median is {} and {}.",
                                  time_text(medians_ms.front()), time_text(medians_ms.back()));
  }
  if (is_log) figure.caption += kLogNote;
  return figure;
}

// A figure of the first pipelines together, then one for each.
template <class Make>
std::vector<Figure> together_and_each(const Results& results, const Make& make) {
  std::vector<Figure> figures = {make(first_rows(results))};
  if (results.rows.size() > kMostTogether) {
    figures.front().caption +=
        fmt::format(" The first {} of {} pipelines.", kMostTogether, results.rows.size());
  }
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    figures.push_back(make({{&results.rows[i], static_cast<int>(i)}}));
    figures.back().pipeline = results.rows[i].pipeline;
  }
  return figures;
}

// The parts of an error, named.
using NamedParts = std::vector<std::pair<std::string_view, const BudgetPart*>>;

FigurePanel parts_panel(const std::string& title, const BudgetPart& total,
                        const NamedParts& parts) {
  FigurePanel made = panel(fmt::format("{}: {} in all (bars: mean, dots: 5 and 95 % of the seeds)",
                                       title, time_text(total.mean)),
                           "", "part (ms)");
  FigureSeries bars = series("mean over seeds", Mark::kBars, 0);
  FigureSeries low = series("5 %", Mark::kPoints, 1);
  FigureSeries high = series("95 %", Mark::kPoints, 1);
  for (const auto& [name, part] : parts) {
    const auto x = static_cast<double>(made.categories.size());
    made.categories.emplace_back(name);
    for (FigureSeries* each : {&bars, &low, &high}) each->x.push_back(x);
    bars.y.push_back(part->mean);
    low.y.push_back(part->p05);
    high.y.push_back(part->p95);
  }
  made.series = {std::move(bars), std::move(low), std::move(high)};
  return made;
}

NamedParts named_parts(const Budget& budget, const ErrorParts& error) {
  NamedParts parts;
  parts.reserve(error.stages.size() + 1);
  for (const evaluation::BudgetStage stage : evaluation::budget_stages(budget)) {
    parts.emplace_back(evaluation::stage_name(budget, stage),
                       &error.stages[static_cast<std::size_t>(stage)]);
  }
  parts.emplace_back("remainder", &error.remainder);
  return parts;
}

NamedParts named_parts(const HostClockBudget& budget) {
  NamedParts parts;
  parts.reserve(budget.parts.size() + 1);
  for (std::size_t i = 0; i < budget.parts.size(); ++i) {
    parts.emplace_back(evaluation::kHostClockParts[i].name, &budget.parts[i]);
  }
  parts.emplace_back("algorithm", &budget.algorithm);
  return parts;
}

std::string host_clock_caption(const HostClockBudget& budget) {
  if (!budget.is_divided) return fmt::format(" Host clock error: not divided: {}.", budget.note);
  return " The host clock error (slaves against the master) loses its estimation where messages "
         "are "
         "ideal, its staleness where oscillators are, its steering where clock calls are; the rest "
         "is the algorithm's own.";
}

}  // namespace

Figure frame_errors(const Archive& archive, std::uint64_t seed) {
  Figure figure = catalogued("frame_errors");
  figure.seed = seed;
  const std::vector<RowRef> rows = four_rows(archive.results);
  FigurePanel amd =
      pulse_panel(rows, seed, "Terms of AMD", "range of the stamps (ms)", &PulseScore::spread_ms);
  if (amd.series.empty()) {
    return absent(std::move(figure),
                  "No pulse was delivered by all of several cameras, or the archive has no "
                  "frames.csv; `simbench run --scenario SCENARIO --output DIR` writes one.");
  }
  add_published(rows, &Published::amd_ms, amd);
  FigurePanel rmdv = pulse_panel(rows, seed, "Terms of RMDV", "deviation from the median (ms)",
                                 &PulseScore::deviation_ms);
  add_published(rows, &Published::rmdv_ms, rmdv);
  figure.caption =
      "One point for every pulse that all cameras delivered; the mean over these is the pipeline's "
      "AMD or RMDV at this seed. Lines are published means." +
      trend_text(rows, seed);
  note_missing(archive.results, figure);
  figure.panels = {std::move(amd), std::move(rmdv)};
  return figure;
}

std::vector<Figure> frame_errors(const Archive& archive) {
  std::vector<Figure> figures;
  for (std::uint64_t i = 0; i < archive.results.seed_count; ++i) {
    figures.push_back(frame_errors(archive, archive.results.first_seed + i));
  }
  return figures;
}

std::vector<Figure> distributions(const Archive& archive) {
  const Results& results = archive.results;
  return together_and_each(
      results, [&](const std::vector<RowRef>& rows) { return distribution(rows, results); });
}

std::vector<Figure> host_order(const Archive& archive) {
  return together_and_each(archive.results, order_figure);
}

Figure budget_figure(const PipelineBudget& pipeline) {
  const Budget& budget = pipeline.stages;
  const HostClockBudget& host_clock = pipeline.host_clock;
  Figure figure = catalogued("budget");
  figure.pipeline = budget.pipeline;
  const char* over = budget.amd_of_sets ? "gathered sets" : "true pulses";
  struct Named {
    std::string title;
    const ErrorParts* parts;
  };
  for (const Named& error :
       {Named{fmt::format("AMD of {}", over), &budget.amd_ms},
        Named{fmt::format("Absolute error of {}", over), &budget.absolute_error_ms},
        Named{"Physical spread of the exposures", &budget.physical_ms}}) {
    if (std::isnan(error.parts->total.mean)) continue;
    figure.panels.push_back(
        parts_panel(error.title, error.parts->total, named_parts(budget, *error.parts)));
  }
  if (figure.panels.empty()) return absent(std::move(figure), "No seed has an error to divide.");
  if (host_clock.is_divided) {
    figure.panels.push_back(
        parts_panel("Host clock error", host_clock.total, named_parts(host_clock)));
  }
  figure.caption = fmt::format(
      "Over {}. A part is the reduction of the error by an ideal stage, averaged over all orders "
      "in "
      "which the stages can be replaced (Shapley values). Parts and remainder add up to the whole; "
      "a part below zero cancels another.{}",
      counted(budget.amd_ms.total.values.size(), "seed"), host_clock_caption(host_clock));
  return figure;
}

}  // namespace simbench::reports
