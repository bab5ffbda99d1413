#include "evaluation/stability/log_entry.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "evaluation/stability/log_lines.h"
#include "recording/date_time.h"
#include "recording/number_in.h"

namespace simbench::evaluation {
namespace {

// The text of a member of a JSON object on one line, into `text`; false if it has none. What JSON
// escapes in such texts are quotes, backslashes and line ends.
bool take_member(std::string_view line, std::string_view key, std::string& text) {
  // By its letters: quotes are frequent, and a search for one that begins so is slow.
  std::size_t found = line.find(key);
  const auto is_quoted = [&] {
    return found > 0 && line[found - 1] == '"' && line.substr(found + key.size()).starts_with('"');
  };
  while (found != std::string_view::npos && !is_quoted()) found = line.find(key, found + 1);
  if (found == std::string_view::npos) return false;
  std::size_t at = line.find_first_not_of(" :", found + key.size() + 1);
  if (at == std::string_view::npos || line[at] != '"') return false;
  text.clear();
  for (++at; at < line.size() && line[at] != '"'; ++at) {
    if (line[at] != '\\' || at + 1 == line.size()) {
      text += line[at];
      continue;
    }
    ++at;
    text += line[at] == 't' ? '\t' : line[at] == 'n' || line[at] == 'r' ? ' ' : line[at];
  }
  return at < line.size();
}

// "Sep  3 10:32:22", of a year that syslog leaves out.
std::optional<WrittenTime> syslog_time_in(std::string_view text) {
  constexpr std::array<std::string_view, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                        "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() < 3) return std::nullopt;
  const auto month = std::ranges::find(kMonths, words[0]);
  const std::optional<unsigned> day = number_in<unsigned>(words[1]);
  const std::optional<Nanoseconds> time = time_of_day_in(words[2]);
  if (month == kMonths.end() || !day || !time) return std::nullopt;
  const std::chrono::year_month_day date{
      std::chrono::year(kYearOfSyslog),
      std::chrono::month(static_cast<unsigned>(month - kMonths.begin()) + 1),
      std::chrono::day(*day)};
  if (!date.ok()) return std::nullopt;
  const Nanoseconds since = std::chrono::sys_days{date}.time_since_epoch() + *time;
  return WrittenTime{.at_s = to_seconds(since), .has_year = false};
}

}  // namespace

std::optional<WrittenTime> written_time_in(std::string_view text) {
  if (text.empty()) return std::nullopt;
  if (const auto micros = number_in<std::int64_t>(text)) {
    return WrittenTime{.at_s = 1e-6 * static_cast<double>(*micros)};
  }
  if (const auto date = date_time_in(text.substr(0, text.find(' ')))) {
    return WrittenTime{.at_s = to_seconds(*date)};
  }
  return syslog_time_in(text);
}

double in_year(double at_s, int year) {
  using std::chrono::sys_days;
  const auto days_s = [](int of, unsigned month) {
    const sys_days day = std::chrono::year(of) / std::chrono::month(month) / 1;
    return static_cast<double>(std::chrono::seconds(day.time_since_epoch()).count());
  };
  // From March on no leap day comes between.
  const unsigned from = at_s < days_s(kYearOfSyslog, 3) ? 1 : 3;
  return at_s - days_s(kYearOfSyslog, from) + days_s(year, from);
}

std::optional<LogEntry> JournalText::read(std::string_view line) {
  if (line.starts_with('{')) return read_json(line);
  if (line.starts_with("__CURSOR=") || line.starts_with("__REALTIME_TIMESTAMP=")) exporting_ = true;
  if (exporting_) return read_export(line);
  return LogEntry{.message = line};
}

std::optional<LogEntry> JournalText::read_json(std::string_view line) {
  if (!take_member(line, "MESSAGE", message_)) {
    if (!take_member(line, "log", message_)) return std::nullopt;
    if (!take_member(line, "time", written_)) written_.clear();
    return LogEntry{.message = message_, .written = written_};
  }
  if (!take_member(line, "_HOSTNAME", host_)) host_.clear();
  if (!take_member(line, "SYSLOG_IDENTIFIER", program_)) program_.clear();
  if (!take_member(line, "_PID", process_)) process_.clear();
  if (!take_member(line, "__REALTIME_TIMESTAMP", written_)) written_.clear();
  return LogEntry{host_, program_, process_, message_, written_};
}

std::optional<LogEntry> JournalText::read_export(std::string_view line) {
  if (line.empty()) {
    if (message_.empty()) return std::nullopt;
    exported_ = std::move(message_);
    message_.clear();
    return LogEntry{host_, program_, process_, exported_, written_};
  }
  const auto take = [&](std::string_view field, std::string& text) {
    if (line.starts_with(field)) text = line.substr(field.size());
  };
  take("MESSAGE=", message_);
  take("_HOSTNAME=", host_);
  take("SYSLOG_IDENTIFIER=", program_);
  take("_PID=", process_);
  take("__REALTIME_TIMESTAMP=", written_);
  return std::nullopt;
}

}  // namespace simbench::evaluation
