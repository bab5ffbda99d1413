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
};

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
  std::string exported_{};  // the message of the last entry
};

}  // namespace simbench::evaluation
