// The frame of every HTML report, and figures as the data that its script draws.
//
// A page has the style, the script, uPlot and the report's own content in one file, which opens
// offline and needs no server. The script draws figures into each <div class="figures"> of an
// <article class="archive">: the n-th data into the n-th article. An article begins with the answer
// and the figures that explain it.
//
// Figures are JSON, small enough for a mail:
//
//   {"figures": [figures with their panels, series and photographs, names as in figure.h],
//    "columns": [...]}
//
// The x and y of a series are numbers of columns; equal columns are stored once. A column has the
// form that takes least room and is exact to 3e-8 of its range (whole numbers: exact):
//
//   {"n", "from", "step"}   equal steps
//   {"min", "unit", "u24"}  min + k unit; k in three bytes, least significant first, in base64;
//                           0xffffff is NaN
//   {"f64"}                 eight bytes each, little endian, in base64: logarithmic axes, and whole
//                           numbers too far apart for three bytes
//
// Long series are thinned without hiding an extreme (thinned() of reports/figures/figure_parts.h).
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

// A part of a page about one result, in the order in which it is read. Members are HTML but for
// name, heading and ids; "" leaves a part out.
struct HtmlArticle {
  std::size_t number = 0;  // among the page's
  std::string name;        // for the switch between them
  std::string heading;
  AnswerText answer{};
  std::string lead{};                       // a figure without a script
  std::vector<std::string> lead_figures{};  // ids of those of its data that follow
  std::string lead_pipeline{};              // which alternative these show first; text
  std::string summary{};                    // the table that most readers want
  std::string about{};                      // what the result is of
  std::string body{};
  bool has_more_figures = false;  // than those that lead
  std::string figure_notes{};
  std::string reproduce{};
};

std::string html_article(const HtmlArticle& article);

struct HtmlPage {
  std::string title;              // text
  std::string subtitle;           // text
  std::string main;               // HTML
  std::vector<std::string> data;  // figures_json(), one for each article
};

std::string html_page(const HtmlPage& page);

// <p class="style">text</p>, the text escaped; "" for an empty text.
std::string html_paragraph(std::string_view style, const std::string& text);
// A list of notes; "" without notes.
std::string html_notes(const std::vector<std::string>& notes);
// A command that reproduces a result.
std::string html_command(std::string_view what, const std::string& command);
// The resolved scenario, folded; `use`: HTML that says what it is good for.
std::string html_scenario(const std::string& use, const std::string& scenario);

std::string figures_json(const std::vector<Figure>& figures);

// RFC 4648, with padding.
std::string base64(const std::string& bytes);

// Columns in the order of their first use, equal ones once.
class HtmlColumns {
 public:
  // Returns the number of the column. `relative`: exact relative to each value, not to the range.
  std::size_t add(const std::vector<double>& values, bool relative);
  const nlohmann::ordered_json& json() const { return columns_; }

 private:
  nlohmann::ordered_json columns_ = nlohmann::ordered_json::array();
  std::map<std::string, std::size_t> known_;  // by their text
};

}  // namespace simbench::reports
