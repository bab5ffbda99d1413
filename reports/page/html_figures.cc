#include "reports/page/html_figures.h"

#include <nlohmann/json.hpp>

#include "reports/page/html_columns.h"

namespace simbench::reports {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(Mark mark) {
  switch (mark) {
    case Mark::kPoints:
      return "points";
    case Mark::kLine:
      return "line";
    case Mark::kSteps:
      return "steps";
    case Mark::kBars:
      return "bars";
  }
  return "";
}

Json series_json(const FigureSeries& series, bool log_y, HtmlColumns& columns) {
  return {{"label", series.label},
          {"mark", name_of(series.mark)},
          {"colour", series.colour},
          {"x", columns.add(series.x, false)},
          {"y", columns.add(series.y, log_y)}};
}

Json panel_json(const FigurePanel& panel, HtmlColumns& columns) {
  Json json = {
      {"title", panel.title},    {"x_label", panel.x_label},       {"y_label", panel.y_label},
      {"log_y", panel.log_y},    {"x_is_pulse", panel.x_is_pulse}, {"categories", panel.categories},
      {"series", Json::array()}, {"lines", Json::array()},         {"spans", Json::array()}};
  for (const FigureSeries& series : panel.series) {
    json["series"].push_back(series_json(series, panel.log_y, columns));
  }
  for (const FigureLine& line : panel.lines) {
    json["lines"].push_back({{"label", line.label}, {"vertical", line.vertical}, {"at", line.at}});
  }
  for (const FigureSpan& span : panel.spans) {
    json["spans"].push_back({{"label", span.label}, {"from", span.from}, {"to", span.to}});
  }
  return json;
}

Json photographs_json(const PhotographRow& row) {
  Json photographs = Json::array();
  for (const Photograph& photograph : row.photographs) {
    Json readings = Json::array();
    for (const PhotographedReading& reading : photograph.readings) {
      readings.push_back({{"text", reading.text}, {"share", reading.share}});
    }
    photographs.push_back({{"label", photograph.label}, {"readings", readings}});
  }
  return {{"label", row.label}, {"photographs", photographs}};
}

Json figure_json(const Figure& figure, HtmlColumns& columns) {
  Json json = {
      {"id", figure.id},         {"title", figure.title},       {"caption", figure.caption},
      {"paper", figure.paper},   {"pipeline", figure.pipeline}, {"seed", nullptr},
      {"absent", figure.absent}, {"panels", Json::array()},     {"photographs", Json::array()}};
  // As text: a seed may be larger than what JavaScript counts exactly.
  if (figure.seed) json["seed"] = std::to_string(*figure.seed);
  for (const FigurePanel& panel : figure.panels) {
    json["panels"].push_back(panel_json(panel, columns));
  }
  for (const PhotographRow& row : figure.photographs) {
    json["photographs"].push_back(photographs_json(row));
  }
  return json;
}

}  // namespace

std::string figures_json(const std::vector<Figure>& figures) {
  HtmlColumns columns;
  Json json = {{"figures", Json::array()}};
  for (const Figure& figure : figures) json["figures"].push_back(figure_json(figure, columns));
  json["columns"] = columns.json();
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace simbench::reports
