#include "reports/page/html_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "recording/text_fields.h"
#include "reports/page/page_frame.h"
#include "reports/text/escaped_text.h"
#include "reports/text/json_node.h"

namespace simbench::reports {
namespace {

constexpr std::uint32_t kNoNumber = 0xffffff;
constexpr double kLargestStep = kNoNumber - 1;

struct Summary {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  bool whole = true;
  bool any() const { return min <= max; }
};

Summary summary_of(const std::vector<double>& values) {
  Summary summary;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    summary.min = std::min(summary.min, value);
    summary.max = std::max(summary.max, value);
    summary.whole = summary.whole && value == std::nearbyint(value);
  }
  return summary;
}

// Equal steps, exactly: the page computes from + i * step.
std::optional<Json> as_steps(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  const double from = values[0];
  const double step = values[1] - from;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] == from + static_cast<double>(i) * step)) return std::nullopt;
  }
  return Json{{"n", values.size()}, {"from", from}, {"step", step}};
}

std::optional<Json> as_three_bytes(const std::vector<double>& values) {
  const Summary summary = summary_of(values);
  const double range = summary.any() ? summary.max - summary.min : 0;
  if (!std::isfinite(range) || (summary.whole && range > kLargestStep)) return std::nullopt;
  const double unit = summary.whole || range == 0 ? 1 : range / kLargestStep;
  if (unit == 0) return std::nullopt;
  std::string bytes;
  bytes.reserve(values.size() * 3);
  for (const double value : values) {
    const std::uint32_t k =
        std::isfinite(value)
            ? static_cast<std::uint32_t>(std::nearbyint((value - summary.min) / unit))
            : kNoNumber;
    for (int shift = 0; shift < 24; shift += 8) bytes += static_cast<char>((k >> shift) & 0xff);
  }
  return Json{{"min", summary.any() ? summary.min : 0.0}, {"unit", unit}, {"u24", base64(bytes)}};
}

Json as_doubles(const std::vector<double>& values) {
  std::string bytes;
  bytes.reserve(values.size() * 8);
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>((bits >> shift) & 0xff);
  }
  return Json{{"f64", base64(bytes)}};
}

Json encoded(const std::vector<double>& values, bool relative) {
  if (auto steps = as_steps(values)) return *steps;
  if (!relative) {
    if (auto bytes = as_three_bytes(values)) return *bytes;
  }
  return as_doubles(values);
}

const char* mark_name(Mark mark) {
  switch (mark) {
    case Mark::kPoints:
      return "points";
    case Mark::kLine:
    case Mark::kMarkedLine:
      return "line";
    case Mark::kSteps:
      return "steps";
    case Mark::kBars:
      return "bars";
  }
  return "";
}

Json figure_series_json(const FigureSeries& series, bool log_y, HtmlColumns& columns) {
  return {{"label", series.label},
          {"mark", mark_name(series.mark)},
          {"colour", series.colour},
          {"x", columns.add(series.x, false)},
          {"y", columns.add(series.y, log_y)}};
}

Json panel_json(const FigurePanel& panel, HtmlColumns& columns) {
  Json json = {{"title", panel.title},           {"x_label", panel.x_label},
               {"y_label", panel.y_label},       {"log_x", panel.log_x},
               {"log_y", panel.log_y},           {"x_is_pulse", panel.x_is_pulse},
               {"categories", panel.categories}, {"series", Json::array()},
               {"lines", Json::array()},         {"spans", Json::array()}};
  for (const FigureSeries& series : panel.series) {
    json["series"].push_back(figure_series_json(series, panel.log_y, columns));
  }
  for (const FigureLine& line : panel.lines) {
    json["lines"].push_back({{"label", line.label},
                             {"vertical", line.vertical},
                             {"at", line.at},
                             {"colour", line.colour}});
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

// Names in a figure may come from a file that anyone wrote; the page draws them.
void make_printable(Json& json) {
  if (json.is_string()) {
    json = printable_lines(json.get_ref<const std::string&>());
  } else if (json.is_structured()) {
    for (Json& member : json) make_printable(member);
  }
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : kDigits[(group >> (18 - 6 * k)) & 63];
    }
  }
  return text;
}

std::size_t HtmlColumns::add(const std::vector<double>& values, bool relative) {
  Json column = encoded(values, relative);
  const auto [place, is_new] = known_.try_emplace(column.dump(), columns_.size());
  if (is_new) columns_.push_back(std::move(column));
  return place->second;
}

std::string figures_json(const std::vector<Figure>& figures) {
  HtmlColumns columns;
  Json json = {{"figures", Json::array()}};
  for (const Figure& figure : figures) json["figures"].push_back(figure_json(figure, columns));
  make_printable(json);
  json["columns"] = columns.json();
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string html_article(const HtmlArticle& article) {
  std::string lead = article.lead;
  if (!article.lead_figures.empty()) {
    lead +=
        fmt::format("<div class=\"figures lead\" data-figures=\"{}\" data-pipeline=\"{}\"></div>\n",
                    html_escaped(fmt::format("{}", fmt::join(article.lead_figures, " "))),
                    html_escaped(article.lead_pipeline));
  }
  std::string figures;
  if (article.has_more_figures) {
    figures =
        fmt::format("<h3>Figures</h3>\n{}<div class=\"figures\"></div>\n", article.figure_notes);
  }
  return fmt::format(
      "<article class=\"archive\" data-archive=\"{}\" data-name=\"{}\">\n<h2>{}</h2>\n"
      "{}{}{}{}{}{}<section class=\"reproduce\"><h3>How to reproduce it</h3>\n{}</section>\n"
      "</article>\n",
      article.number, html_escaped(article.name), html_escaped(article.heading),
      html(article.answer), lead, article.summary, article.about, article.body, figures,
      article.reproduce);
}

std::string html_page(const HtmlPage& page) {
  std::string data;
  for (const std::string& json : page.data) {
    data += fmt::format("<script type=\"application/json\" class=\"data\">{}</script>\n",
                        script_safe(json));
  }
  return framed_page(
      {.page = web::page(),
       .title = page.title,
       .script = web::script(),
       .more = {{"subtitle", html_escaped(page.subtitle)}, {"main", page.main}, {"data", data}}});
}

std::string html_paragraph(std::string_view style, const std::string& text) {
  if (text.empty()) return "";
  return fmt::format("<p class=\"{}\">{}</p>\n", style, html_escaped(text));
}

std::string html_notes(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string items;
  for (const std::string& note : notes) {
    items += fmt::format("<li>{}</li>\n", html_escaped(note));
  }
  return fmt::format("<ul class=\"notes\" aria-label=\"notes\">\n{}</ul>\n", items);
}

std::string html_command(std::string_view what, const std::string& command) {
  return fmt::format("<dt>{}</dt><dd><pre class=\"scroll\" tabindex=\"0\">{}</pre></dd>\n",
                     html_escaped(what), html_escaped(command));
}

std::string html_scenario(const std::string& use, const std::string& scenario) {
  return fmt::format(
      "<details><summary>The resolved scenario</summary>\n{}"
      "<pre class=\"scroll\" tabindex=\"0\">{}</pre>\n</details>\n",
      use.empty() ? "" : fmt::format("<p>{}</p>\n", use), html_escaped(scenario));
}

}  // namespace simbench::reports
