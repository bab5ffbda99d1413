#include "reports/results/published_figures_json.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "evaluation/scoring/metrics.h"

namespace simbench::reports {
namespace {

using evaluation::FigureComparison;

constexpr const char* kFigures = "published_figures";

Json published_figure_json(const FigureComparison& compared) {
  const scenarios::PublishedFigure& figure = compared.figure;
  Json entry = {
      {"pipeline", figure.pipeline},
      {"metric", figure.metric},
      {figure.number_name(), figure.number()},
      {"conditions", figure.conditions},
      {"source", figure.source},
      {"percentile", compared.percentile.percent},
      {"percentile_interval", Json::array({compared.percentile.low, compared.percentile.high})}};
  if (!figure.value) {
    entry["kept_percent"] = compared.kept.percent;
    entry["kept_percent_interval"] = Json::array({compared.kept.low, compared.kept.high});
  }
  const std::string_view verdict = evaluation::verdict_word(compared.verdict);
  entry["verdict"] = verdict.empty() ? Json() : Json(verdict);
  return entry;
}

const evaluation::Metric& read_figure_metric(const JsonNode& node) {
  const std::string id = node.text();
  const auto found = std::ranges::find_if(evaluation::metrics(), [&id](const auto& metric) {
    return metric.is_series() && metric.id == id;
  });
  if (found == evaluation::metrics().end()) node.refuse("a metric with a value of each seed");
  return *found;
}

scenarios::PublishedFigure read_figure(const JsonNode& node) {
  scenarios::PublishedFigure figure;
  figure.pipeline = node["pipeline"].text();
  const evaluation::Metric& metric = read_figure_metric(node["metric"]);
  figure.metric = metric.id;
  int stated = 0;
  const auto read = [&](const char* name, std::optional<double>& number) {
    if (!node.has(name)) return;
    ++stated;
    if (node[name].is_null()) node[name].refuse("a number");
    number = node[name].value_of(metric);
  };
  read("at_most", figure.at_most);
  read("value", figure.value);
  read("at_least", figure.at_least);
  if (stated != 1) node.refuse("exactly one of at_most, value and at_least");
  figure.conditions = node["conditions"].text();
  figure.source = node["source"].text();
  return figure;
}

}  // namespace

void state_published_figures(const evaluation::Results& results, Json& root) {
  if (results.published_figures.empty()) return;
  Json& all = root[kFigures] = Json::array();
  for (const FigureComparison& compared : results.published_figures) {
    all.push_back(published_figure_json(compared));
  }
}

std::vector<FigureComparison> read_published_figures(const JsonNode& root,
                                                     std::span<const evaluation::Row> rows) {
  std::vector<FigureComparison> all;
  if (!root.has(kFigures)) return all;
  for (const JsonNode& node : root[kFigures].elements()) {
    const scenarios::PublishedFigure figure = read_figure(node);
    const evaluation::Row* const row = find_row(rows, figure.pipeline);
    if (row == nullptr) node["pipeline"].refuse("a pipeline of /rows");
    all.push_back(compare_figure(figure, *row));
  }
  return all;
}

}  // namespace simbench::reports
