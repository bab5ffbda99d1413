// The page of `simbench watch`, complete in itself; it asks its server for the snapshot of a
// monitor (watch/monitor.h) once a second.
//
//   const std::string page = watch_html();
#pragma once

#include <string>

namespace simbench::reports {

std::string watch_html();

}  // namespace simbench::reports
