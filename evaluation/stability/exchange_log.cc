#include "evaluation/stability/exchange_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/line_reader.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kAllowed =
    "ntpd's rawstats, chrony's measurements.log or refclocks.log: logs with what was exchanged";

// chrony's time of an exchange is a whole second, somewhere between its first and last stamp.
constexpr Nanoseconds kSecond = std::chrono::seconds(1);
// Offsets and delays beyond 11 days are those of clocks that were not set.
constexpr double kFarS = 1e6;
// What chrony prints has four digits.
constexpr double kPrinted = 5e-4;

Nanoseconds from_seconds(double seconds) { return from_ms(seconds * 1e3); }

// Only the offset and the delay of the exchange are known: both stamps of the server are one.
LoggedExchange exchange_of(const LogLine& line, double delay_s) {
  const Nanoseconds offset = from_seconds(-line.point.error_s);
  const Nanoseconds delay = std::max(from_seconds(delay_s), Nanoseconds(0));
  const HostTime middle{Nanoseconds(line.point.time) + kSecond / 2};
  LoggedExchange exchange{.server = std::string(line.name)};
  exchange.t1 = middle - delay / 2;
  exchange.t2 = exchange.t3 = middle + offset;
  exchange.t4 = exchange.t1 + delay;
  exchange.common_error = kSecond;
  exchange.error =
      from_seconds(kPrinted * (std::abs(line.point.error_s) + delay_s)) + Nanoseconds(1);
  exchange.is_estimated = true;
  return exchange;
}

LoggedPulse pulse_of(const LogLine& line) {
  const Nanoseconds offset = from_seconds(-line.point.error_s);
  const Nanoseconds about = Nanoseconds(line.point.time) + offset;
  const Nanoseconds second = std::chrono::round<std::chrono::seconds>(about);
  return {std::string(line.name), HostTime(second - offset), second};
}

bool is_near(double seconds) { return std::abs(seconds) <= kFarS; }

// False for clocks that never were set, which prove nothing.
bool keep(const LogLine& line, ExchangeLog& log) {
  if (!is_near(line.point.error_s) || !is_near(line.delay_s.value_or(0))) return false;
  if (line.stamps) {
    const auto& [t1, t2, t3, t4] = *line.stamps;
    if (!is_near(to_seconds(t4 - t1)) || !is_near(to_seconds(t3 - t2))) return false;
    LoggedExchange exchange{
        .server = std::string(line.name), .t1 = t1, .t2 = t2, .t3 = t3, .t4 = t4};
    exchange.error = Nanoseconds(1);
    log.exchanges.push_back(exchange);
  } else if (line.delay_s) {
    log.exchanges.push_back(exchange_of(line, *line.delay_s));
  } else if (line.is_pulse) {
    log.pulses.push_back(pulse_of(line));
  }
  return true;
}

// Reads all lines in the first form that has one of them.
class ExchangeLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) {
    if (lines_) return lines_->read(line, place);
    for (const auto& make : {rawstats_lines, chrony_measurements_lines, chrony_refclocks_lines}) {
      std::unique_ptr<LogLines> lines = make();
      const std::optional<LogLine> found = tried(*lines, line, place);
      if (!found && lines->skipped() == 0) continue;
      lines_ = std::move(lines);
      return found;
    }
    if (!other_ && (other_ = what_else(line, place))) other_line_ = place.line;
    return std::nullopt;
  }

  // For a file without an exchange.
  [[noreturn]] void fail(const LogPlace& end) const {
    if (other_)
      LogPlace{end.path, other_line_}.fail(fmt::format("found {}, allowed: {}", *other_, kAllowed));
    if (!damaged_.empty()) throw scenarios::InputError(damaged_);
    end.fail(fmt::format("the file ends without an exchange, allowed: {}", kAllowed));
  }

  std::vector<std::string> notes() const {
    return lines_ ? lines_->notes() : std::vector<std::string>();
  }

 private:
  // A line of a form that is not known yet may look damaged to another form.
  std::optional<LogLine> tried(LogLines& lines, std::string_view line, const LogPlace& place) {
    try {
      return lines.read(line, place);
    } catch (const scenarios::InputError& error) {
      if (damaged_.empty()) damaged_ = error.what();
      return std::nullopt;
    }
  }

  // A log of estimates.
  static std::optional<std::string> what_else(std::string_view line, const LogPlace& place) {
    for (const LogFormat& format : log_formats()) {
      try {
        if (format.make()->read(line, place)) {
          return fmt::format("{}, which has no exchanges", format.text);
        }
      } catch (const scenarios::InputError&) {
        // It is of another form, or damaged.
      }
    }
    return std::nullopt;
  }

  std::unique_ptr<LogLines> lines_{};
  std::optional<std::string> other_{};
  std::size_t other_line_ = 0;
  std::string damaged_{};
};

// What a program had still to slew at an exchange is no more than what it had measured before: the
// stamps may be off by as much.
void widen_estimates(std::vector<LoggedExchange>& exchanges) {
  constexpr std::size_t kBefore = 8;
  std::vector<Nanoseconds> offsets;
  for (const LoggedExchange& exchange : exchanges) {
    const Nanoseconds there = exchange.t2 - exchange.t1;
    const Nanoseconds back = exchange.t3 - exchange.t4;
    offsets.push_back(std::chrono::abs(there / 2 + back / 2));
  }
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    if (!exchanges[i].is_estimated) continue;
    const std::size_t first = i - std::min(i, kBefore);
    exchanges[i].error += *std::max_element(offsets.begin() + static_cast<std::ptrdiff_t>(first),
                                            offsets.begin() + static_cast<std::ptrdiff_t>(i + 1));
  }
}

ExchangeLog read_all(LineReader reader) {
  ExchangeLog log{.path = reader.path()};
  ExchangeLines lines;
  std::uint64_t far = 0;
  while (const std::optional<std::string_view> line = reader.next()) {
    const std::optional<LogLine> found = lines.read(*line, {log.path, reader.line()});
    if (!found) continue;
    log.format = found->format;
    if (!keep(*found, log)) ++far;
  }
  if (log.exchanges.empty() && log.pulses.empty()) lines.fail({log.path, reader.line()});
  widen_estimates(log.exchanges);
  for (const std::string& note : lines.notes()) log.notes.push_back(log.path + ": " + note);
  if (far > 0) {
    log.notes.push_back(fmt::format("{}: {} with an offset or a delay beyond 11 days left out",
                                    log.path, counted(far, "exchange")));
  }
  if (reader.torn()) {
    log.notes.push_back(fmt::format(
        "{}: the last line has no line end and may be cut; it was left out", reader.place()));
  }
  return log;
}

// A file that cannot be read is the user's, too.
template <class... Source>
ExchangeLog read_from(const Source&... source) {
  try {
    return read_all(LineReader(source...));
  } catch (const LineError& error) {
    throw scenarios::InputError(error.what());
  }
}

}  // namespace

ExchangeLog read_exchange_log(const std::string& path) { return read_from(path); }

ExchangeLog parse_exchange_log(std::string_view text, const std::string& path) {
  return read_from(path, text);
}

}  // namespace simbench::evaluation
