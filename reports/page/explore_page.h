// The page of `simbench explore`, complete in itself: the scripts of reports/web/ and uPlot.
//
// Served, it asks its server for all it shows. Exported, it holds what it shows (`stored`, JSON of
// explore/demo.h) and needs no server.
//
//   const std::string page = explore_html();
#pragma once

#include <string>

namespace simbench::reports {

std::string explore_html(const std::string& stored = "");

}  // namespace simbench::reports
