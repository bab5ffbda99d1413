#include "app/exchange_logs.h"

#include <fmt/format.h>

#include <utility>

#include "recording/number_in.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

struct OfHost {
  std::uint32_t host = 0;
  std::string text{};
};

OfHost of_host(const char* option, const char* what, const std::string& given, std::int64_t hosts) {
  const std::size_t equals = given.find('=');
  const auto host = number_in<std::uint32_t>(given.substr(0, equals));
  if (equals == std::string::npos || equals + 1 == given.size() || !host || *host >= hosts) {
    throw scenarios::InputError(fmt::format("{}: found {}, allowed: HOST={}, HOST from 0 to {}",
                                            option, quoted_bytes(given), what, hosts - 1));
  }
  return {*host, given.substr(equals + 1)};
}

void shift(evaluation::ExchangeLog& log, Nanoseconds epoch) {
  for (evaluation::LoggedExchange& exchange : log.exchanges) {
    for (HostTime* const stamp : {&exchange.t1, &exchange.t2, &exchange.t3, &exchange.t4}) {
      *stamp -= epoch;
    }
  }
  for (evaluation::LoggedPulse& pulse : log.pulses) {
    pulse.read -= epoch;
    pulse.second -= epoch;
  }
}

}  // namespace

ExchangeLogs exchange_logs(const std::vector<std::string>& given,
                           const std::vector<std::string>& addresses, const RecordedRun& run) {
  const std::int64_t hosts = run.scenario().hosts.count;
  ExchangeLogs found;
  for (const std::string& text : given) {
    const OfHost file = of_host("--clock-log", "FILE", text, hosts);
    evaluation::ExchangeLog log = evaluation::read_exchange_log(file.text);
    found.notes.insert(found.notes.end(), log.notes.begin(), log.notes.end());
    shift(log, run.calendar_zero());
    found.logs.push_back({file.host, std::move(log)});
  }
  for (const std::string& text : addresses) {
    const OfHost address = of_host("--host-address", "ADDRESS", text, hosts);
    if (!found.host_of_address.emplace(address.text, address.host).second) {
      throw scenarios::InputError(fmt::format("--host-address: found {} twice, allowed: one host",
                                              quoted_bytes(address.text)));
    }
  }
  return found;
}

}  // namespace simbench::app
