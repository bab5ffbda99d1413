// What recordings have, for a report (reports/recordings/inspect_report.h).
//
//   const std::vector<reports::Inspection> found = inspected({"rig.bag"}, {}, {"hull_300"});
//   print(plain(reports::inspect_document(found)));
#pragma once

#include <string>
#include <vector>

#include "bags/recorded_files.h"
#include "recording/recorded_streams.h"
#include "reports/recordings/inspect_report.h"

namespace simbench::app {

// `paths`: recording folders and files, each by itself, but with the names of cameras that files of
// one rig have. Throws what recorded_streams() and, of `device_times`, stamped_streams() do.
std::vector<reports::Inspection> inspected(const std::vector<std::string>& paths,
                                           const bags::FileOptions& options,
                                           const std::vector<std::string>& device_times = {},
                                           const ReadProgress& progress = {});

}  // namespace simbench::app
