#include "reports/page/page_frame.h"

#include <fmt/format.h>

#include "recording/version.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {

std::string framed_page(FramedPage page) {
  std::vector<std::pair<std::string_view, std::string>> values = std::move(page.more);
  values.insert(values.end(), {{"title", html_escaped(page.title)},
                               {"more_sources", page.asks_server ? "; connect-src 'self'" : ""},
                               {"uplot_licence", std::string(web::uplot_licence())},
                               {"uplot_style", std::string(web::uplot_style())},
                               {"style", std::string(web::style()) + std::string(page.style)},
                               {"version", fmt::format("simbench {} ({})", html_escaped(version()),
                                                       html_escaped(commit()))},
                               {"uplot_script", std::string(web::uplot_script())},
                               {"script", std::string(page.script)}});
  return filled(page.page, values);
}

}  // namespace simbench::reports
