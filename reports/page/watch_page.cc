#include "reports/page/watch_page.h"

#include <fmt/format.h>

#include "recording/version.h"
#include "reports/page/web_files.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {

std::string watch_html() {
  return filled(web::watch_page(),
                {{"uplot_licence", std::string(web::uplot_licence())},
                 {"uplot_style", std::string(web::uplot_style())},
                 {"style", std::string(web::style())},
                 {"watch_style", std::string(web::watch_style())},
                 {"version",
                  fmt::format("simbench {} ({})", html_escaped(version()), html_escaped(commit()))},
                 {"uplot_script", std::string(web::uplot_script())},
                 {"script", std::string(web::watch_script())}});
}

}  // namespace simbench::reports
