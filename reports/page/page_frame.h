// What every HTML page has in common: the head, the style, uPlot, the script, the version.
//
// A page of reports/web/ is a template ({{name}}, reports/text/escaped_text.h) whose head is
// head.html. Its content security policy lets it load nothing; a page that is served may ask its
// own server.
//
//   const std::string html = framed_page({.page = web::watch_page(), .title = "simbench watch",
//                                         .script = web::watch_script(), .more = {}});
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/page/web_files.h"

namespace simbench::reports {

struct FramedPage {
  std::string_view page;     // the template
  std::string title;         // text
  std::string_view style{};  // besides the report's
  std::string_view script{};
  bool asks_server = false;
  std::vector<std::pair<std::string_view, std::string>> more;  // values of the template's own names
};

std::string framed_page(FramedPage page);

}  // namespace simbench::reports
