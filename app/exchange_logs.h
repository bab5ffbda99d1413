// Logs of exchanges as a user names them: "HOST=FILE", HOST a number of the rig's hosts, and the
// addresses that the hosts have in them: "HOST=ADDRESS".
//
//   const RecordedRun monday("monday");
//   const ExchangeLogs found = exchange_logs({"1=rawstats"}, {"0=192.0.2.1"}, monday);
//   evaluation::CertificateOptions certificates;
//   certificates.logs = found.logs;
//
// Stamps count from 1970 in the files. In a recording of a simulated world, whose programs see its
// own calendar, they are shifted to the clocks of the recording.
//
// Errors: scenarios::InputError: what evaluation/stability/exchange_log.h has, and for no or
// another host.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/recordings.h"
#include "evaluation/run/certificate_run.h"

namespace simbench::app {

struct ExchangeLogs {
  std::vector<evaluation::HostExchangeLog> logs{};
  std::map<std::string, std::uint32_t> host_of_address{};
  std::vector<std::string> notes{};  // for the user: what was left out
};

ExchangeLogs exchange_logs(const std::vector<std::string>& given,
                           const std::vector<std::string>& addresses, const RecordedRun& run);

}  // namespace simbench::app
