// What a daemon said, out of what a collector of logs made of it: JSON of journalctl and Docker,
// journalctl's export form, or a line as it is.
//
//   JournalText text_of_journal;
//   const auto entry = text_of_journal.read("{\"_HOSTNAME\":\"n\",\"MESSAGE\":\"hello\"}");
//   if (entry) use(entry->host, entry->message);
//
// Complexity: linear, one pass a line; texts are valid until the next call.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simbench::evaluation {

struct LogEntry {
  std::string_view host{};
  std::string_view program{};
  std::string_view process{};
  std::string_view message{};  // of a line that is none of these forms, the line
  std::string_view written{};  // when: microseconds since 1970, or ISO 8601; may be empty
};

// The date of a line: microseconds since 1970 (journald), ISO 8601 (Docker, Kubernetes, rsyslog) or
// syslog's "Sep  3 10:32:22", which has no year: then it is of kYearOfSyslog.
struct WrittenTime {
  double at_s = 0;  // since 1970
  bool has_year = true;
};
inline constexpr int kYearOfSyslog = 2024;  // has a 29 February
std::optional<WrittenTime> written_time_in(std::string_view text);
// Moves a time to the same day and time of another year.
double in_year(double at_s, int year);

class JournalText {
 public:
  // Nothing for a line inside an entry of the export form.
  std::optional<LogEntry> read(std::string_view line);

 private:
  std::optional<LogEntry> read_json(std::string_view line);
  std::optional<LogEntry> read_export(std::string_view line);

  bool exporting_ = false;
  std::string host_{};
  std::string program_{};
  std::string process_{};
  std::string message_{};
  std::string written_{};
  std::string exported_{};  // the message of the last entry
};

}  // namespace simbench::evaluation
