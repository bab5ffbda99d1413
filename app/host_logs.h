// Logs of hosts' clocks as a user names them: "HOST=FILE", or a file alone, of whatever form
// `simbench stability` reads. Each series of a file is a log; a table is one.
//
//   const app::HostLogs found = app::host_logs({"left=ptp4l.log", "tracking.log"});
//   evaluation::DiagnoseOptions options;
//   options.clock_logs = found.logs;
//   const evaluation::Diagnosis d = evaluation::diagnose(recorded.streams, options);
//
// Errors: scenarios::InputError, as read_clock_log() has them. Complexity: linear in the files, for
// each series.
#pragma once

#include <string>
#include <vector>

#include "evaluation/diagnosis/clock_account.h"

namespace simbench::app {

struct HostLogs {
  std::vector<evaluation::HostLog> logs{};
  std::vector<std::string> notes{};  // for the user: what was left out
};

// A name with '=' that exists is a file.
HostLogs host_logs(const std::vector<std::string>& given);

}  // namespace simbench::app
