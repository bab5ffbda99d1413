// The frame of every report: the style, the script that draws figures, uPlot, and whatever stands
// between them. One file that opens offline and asks nothing of any server.
//
// The script draws figures (reports/page/html_figures.h) into each <div class="figures"> of an
// <article class="archive">: the n-th data into the n-th article.
#ifndef SIMBENCH_REPORTS_PAGE_HTML_PAGE_H_
#define SIMBENCH_REPORTS_PAGE_HTML_PAGE_H_

#include <string>
#include <string_view>
#include <vector>

namespace simbench::reports {

struct HtmlPage {
  std::string title;              // text
  std::string subtitle;           // text
  std::string main;               // HTML
  std::vector<std::string> data;  // figures_json(), one for each article
};

std::string html_page(const HtmlPage& page);

// <p class="style">text</p>, the text escaped; nothing of an empty text.
std::string html_paragraph(std::string_view style, const std::string& text);
// A list of notes; nothing of none.
std::string html_notes(const std::vector<std::string>& notes);
// An entry of the commands that reproduce a result.
std::string html_command(std::string_view what, const std::string& command);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_PAGE_HTML_PAGE_H_
