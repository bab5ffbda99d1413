// What a recording has, for a report (reports/recordings/inspect_report.h).
//
//   const reports::Inspection found = inspected("rig.bag", {}, {"hull_300"});
//   print(plain(reports::inspect_document({found})));
#pragma once

#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "recording/recorded_streams.h"
#include "reports/recordings/inspect_report.h"

namespace simbench::app {

// `path`: a recording folder or a file. Throws what recorded_streams() and, of `device_times`,
// stamped_streams() do.
reports::Inspection inspected(const std::string& path, const bags::FileOptions& options,
                              const std::vector<std::string>& device_times = {},
                              const ReadProgress& progress = {});

}  // namespace simbench::app
