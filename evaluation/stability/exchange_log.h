// Exchanges that other programs logged: four stamps, or what comes to the same.
//
// - ntpd: rawstats, which has the four stamps as ntpd read them.
// - chrony: measurements.log, which has the offset and the delay of each exchange, and its time in
//   whole seconds. chronyd corrects its readings by what it still has to slew, which the log does
//   not say, so they are estimates (LoggedExchange::is_estimated). That is taken to be no more
//   than the largest offset of the exchange and the eight before it, which is an assumption.
// - chrony: refclocks.log, the raw samples of pulses (PPS): the clock's reading at a full second.
//
// Other logs of clocks say how far a program thinks that its clock is off, which proves nothing;
// they are refused by name. Lines that chronyd's tests refused, and exchanges without all stamps or
// whose stamps go back, are left out and counted. A last line without its line end is left out,
// with a note.
//
//   const ExchangeLog log = read_exchange_log("/var/log/ntpsec/rawstats");
//   for (const LoggedExchange& exchange : log.exchanges) use(exchange.server, exchange.t1);
//
// Errors: scenarios::InputError, "FILE:LINE: found ..., allowed: ...". Complexity: linear. Memory:
// some 100 bytes an exchange.
//
// Sources: ntpd's monitoring options (rawstats); chrony.conf(5), sources.c and reference.c of
// chrony 4.3 (what it corrects).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::evaluation {

// Stamps count from 1970.
struct LoggedExchange {
  std::string server{};  // its address or name
  HostTime t1{}, t2{}, t3{}, t4{};
  // All four may be so far off either way, by the same; and each by this besides.
  Nanoseconds common_error{0};
  Nanoseconds error{0};
  bool is_estimated = false;  // the own clock's stamps are no readings
};

struct LoggedPulse {
  std::string source{};
  HostTime read{};        // what the own clock read
  Nanoseconds second{0};  // the full second, since 1970
};

struct ExchangeLog {
  std::string path{};
  std::string format{};  // "ntpd_rawstats", "chrony_measurements", "chrony_refclocks"
  std::vector<LoggedExchange> exchanges{};
  std::vector<LoggedPulse> pulses{};
  std::vector<std::string> notes{};  // what was left out, "FILE: ..." each
};

ExchangeLog read_exchange_log(const std::string& path);
// Reads text as if it were the content of `path`.
ExchangeLog parse_exchange_log(std::string_view text, const std::string& path);

}  // namespace simbench::evaluation
