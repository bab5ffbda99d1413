#include "reports/page/explore_page.h"

#include <fmt/format.h>

#include "reports/page/page_frame.h"
#include "reports/text/escaped_text.h"

namespace simbench::reports {

std::string explore_html(const std::string& stored) {
  const std::string data =
      stored.empty() ? ""
                     : fmt::format("<script type=\"application/json\" id=\"stored\">{}</script>\n",
                                   script_safe(stored));
  return framed_page({.page = web::explore_page(),
                      .title = "simbench explore",
                      .style = web::explore_style(),
                      .script = web::explore_script(),
                      .asks_server = stored.empty(),
                      .more = {{"data", data}}});
}

}  // namespace simbench::reports
