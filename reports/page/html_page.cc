#include "reports/page/html_page.h"

#include <fmt/format.h>

#include "recording/version.h"
#include "reports/page/web_files.h"
#include "reports/text/html_text.h"

namespace simbench::reports {

std::string html_page(const HtmlPage& page) {
  std::string data;
  for (const std::string& json : page.data) {
    data += fmt::format("<script type=\"application/json\" class=\"data\">{}</script>\n",
                        script_safe(json));
  }
  return filled(web::page(), {{"title", html_escaped(page.title)},
                              {"subtitle", html_escaped(page.subtitle)},
                              {"uplot_licence", std::string(web::uplot_licence())},
                              {"uplot_style", std::string(web::uplot_style())},
                              {"style", std::string(web::style())},
                              {"main", page.main},
                              {"version", fmt::format("simbench {} ({})", html_escaped(version()),
                                                      html_escaped(commit()))},
                              {"data", data},
                              {"uplot_script", std::string(web::uplot_script())},
                              {"script", std::string(web::script())}});
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

}  // namespace simbench::reports
