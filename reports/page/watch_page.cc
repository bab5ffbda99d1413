#include "reports/page/watch_page.h"

#include "reports/page/page_frame.h"

namespace simbench::reports {

std::string watch_html() {
  return framed_page({.page = web::watch_page(),
                      .title = "simbench watch",
                      .style = web::watch_style(),
                      .script = web::watch_script(),
                      .asks_server = true,
                      .more = {}});
}

}  // namespace simbench::reports
