#include "evaluation/stability/log_entry.h"

#include <utility>

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

}  // namespace

std::optional<LogEntry> JournalText::read(std::string_view line) {
  if (line.starts_with('{')) return read_json(line);
  if (line.starts_with("__CURSOR=") || line.starts_with("__REALTIME_TIMESTAMP=")) exporting_ = true;
  if (exporting_) return read_export(line);
  return LogEntry{.message = line};
}

std::optional<LogEntry> JournalText::read_json(std::string_view line) {
  if (!take_member(line, "MESSAGE", message_)) {
    if (!take_member(line, "log", message_)) return std::nullopt;
    return LogEntry{.message = message_};
  }
  if (!take_member(line, "_HOSTNAME", host_)) host_.clear();
  if (!take_member(line, "SYSLOG_IDENTIFIER", program_)) program_.clear();
  if (!take_member(line, "_PID", process_)) process_.clear();
  return LogEntry{host_, program_, process_, message_};
}

std::optional<LogEntry> JournalText::read_export(std::string_view line) {
  if (line.empty()) {
    if (message_.empty()) return std::nullopt;
    exported_ = std::move(message_);
    message_.clear();
    return LogEntry{host_, program_, process_, exported_};
  }
  const auto take = [&](std::string_view field, std::string& text) {
    if (line.starts_with(field)) text = line.substr(field.size());
  };
  take("MESSAGE=", message_);
  take("_HOSTNAME=", host_);
  take("SYSLOG_IDENTIFIER=", program_);
  take("_PID=", process_);
  return std::nullopt;
}

}  // namespace simbench::evaluation
