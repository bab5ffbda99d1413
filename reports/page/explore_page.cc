#include "reports/page/explore_page.h"

#include <fmt/format.h>

#include "recording/version.h"
#include "reports/page/web_files.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {

std::string explore_html(const std::string& stored) {
  const std::string data =
      stored.empty() ? ""
                     : fmt::format("<script type=\"application/json\" id=\"stored\">{}</script>\n",
                                   script_safe(stored));
  return filled(web::explore_page(),
                {{"uplot_licence", std::string(web::uplot_licence())},
                 {"uplot_style", std::string(web::uplot_style())},
                 {"style", std::string(web::style())},
                 {"explore_style", std::string(web::explore_style())},
                 {"version",
                  fmt::format("simbench {} ({})", html_escaped(version()), html_escaped(commit()))},
                 {"data", data},
                 {"uplot_script", std::string(web::uplot_script())},
                 {"script", std::string(web::explore_script())}});
}

}  // namespace simbench::reports
