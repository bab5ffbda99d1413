// Reads what ptp4l, phc2sys and ts2phc print, alone or behind the heads of any collector of logs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "evaluation/stability/log_entry.h"
#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/number_in.h"

namespace simbench::evaluation {
namespace {

constexpr std::array<const char*, 3> kPrograms = {"ptp4l", "phc2sys", "ts2phc"};

// The text between brackets at the beginning, which is taken off with the blanks and colons behind
// it.
std::optional<std::string_view> take_brackets(std::string_view& rest) {
  if (!rest.starts_with('[')) return std::nullopt;
  const std::size_t end = rest.find(']');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view inside = rest.substr(1, end - 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(" :", end + 1), rest.size()));
  return inside;
}

// "5374018.735", of the monotonic clock.
bool is_uptime(std::string_view text) {
  const std::size_t point = text.find('.');
  return point != std::string_view::npos && point > 0 && point + 1 < text.size() &&
         text.find_first_not_of("0123456789.") == std::string_view::npos;
}

// The host before the program: the word behind a time, as syslog writes it.
std::string_view host_in(std::string_view head) {
  const std::vector<std::string_view> words = words_of(head);
  if (words.size() < 2) return {};
  const std::string_view host = words.back();
  const bool behind_time = words[words.size() - 2].find(':') != std::string_view::npos;
  const bool name = std::ranges::all_of(host, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_';
  });
  return behind_time && name ? host : std::string_view();
}

struct Head {
  const char* program = nullptr;
  std::string_view host{};
  std::string_view process{};
  std::string_view stamp{};
  std::string_view tag{};
  std::string_view rest{};
  std::string_view written{};  // what may be a date
};

// Takes "ptp4l[263]: [3906.052] ", "ptp4l[3906.052]: " and both off a line; nothing if no program
// of linuxptp speaks.
std::optional<Head> head_of(const LogEntry& entry) {
  std::string_view rest = entry.message;
  Head head{.host = entry.host, .process = entry.process, .written = entry.written};
  const auto known = std::ranges::find(kPrograms, entry.program);
  if (known != kPrograms.end()) head.program = *known;
  for (bool more = true; more;) {
    more = false;
    for (const char* program : kPrograms) {
      const std::string_view name = program;
      for (std::size_t at = rest.find(name); at != std::string_view::npos;
           at = rest.find(name, at + 1)) {
        const std::string_view behind = rest.substr(at + name.size());
        if (!behind.starts_with('[') && !behind.starts_with(": ")) continue;
        if (head.program == nullptr && head.host.empty()) head.host = host_in(rest.substr(0, at));
        if (head.program == nullptr && head.written.empty()) head.written = rest.substr(0, at);
        // Behind the first program only a second head counts, not what it says of another.
        if (head.program != nullptr && at != 0) break;
        head.program = program;
        rest = behind;
        rest.remove_prefix(rest.starts_with(':') ? std::min<std::size_t>(2, rest.size()) : 0);
        const std::optional<std::string_view> inside = take_brackets(rest);
        if (inside) (is_uptime(*inside) ? head.stamp : head.process) = *inside;
        more = true;
        break;
      }
      if (more) break;
    }
  }
  if (head.program == nullptr && !rest.starts_with('[')) return std::nullopt;
  for (std::optional<std::string_view> inside; (inside = take_brackets(rest));) {
    if (head.stamp.empty()) {
      head.stamp = *inside;
    } else {
      head.tag = inside->substr(0, inside->rfind(':'));  // a level stands behind the name
    }
  }
  head.rest = rest;
  return head;
}

// The program, which `journalctl -o cat` leaves out.
const char* program_of(std::string_view message) {
  if (message.find("path delay") != std::string_view::npos) return "ptp4l";
  if (message.find("phc ") != std::string_view::npos ||
      message.find("sys offset") != std::string_view::npos) {
    return "phc2sys";
  }
  return message.starts_with("rms ") ? "ptp4l" : "ts2phc";
}

class LinuxptpLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::optional<LogEntry> entry = journal_.read(line);
    if (!entry) return std::nullopt;
    const std::optional<Head> head = head_of(*entry);
    if (!head) {
      if (!line.empty()) ++others_;
      return std::nullopt;
    }
    const std::vector<std::string_view> words = words_of(head->rest);
    for (std::size_t i = 0; i + 1 < words.size() && i <= 3; ++i) {
      if (words[i] == "rms" && i + 3 < words.size() && words[i + 2] == "max") {
        return summary(*head, words, i, place);
      }
      if (i > 0 && words[i] == "offset") return update(*head, words, i, place);
    }
    return std::nullopt;
  }

  std::vector<std::string> notes() const override {
    if (others_ == 0) return {};
    return {counted(others_, "line") + " of other programs left out"};
  }

  bool absolute() const override { return false; }
  bool is_expected(std::string_view) const override { return true; }  // others are counted here

 private:
  LogLine line_of(const Head& head, const std::vector<std::string_view>& words, std::size_t names,
                  const LogPlace& place) const {
    const std::optional<Microseconds> time = microseconds_of(head.stamp);
    if (!is_uptime(head.stamp) || !time) {
      place.fail("time", head.stamp.empty() ? head.rest : head.stamp,
                 "seconds in brackets, such as ptp4l[5374018.735]");
    }
    LogLine found{.format = head.program != nullptr ? head.program : program_of(head.rest),
                  .host = head.host,
                  .process = head.process,
                  .tag = head.tag,
                  .point = {.time = *time},
                  .written = head.written};
    if (names > 0) {
      const char* end = words[names - 1].data() + words[names - 1].size();
      found.name = {words[0].data(), static_cast<std::size_t>(end - words[0].data())};
    }
    return found;
  }

  std::optional<LogLine> update(const Head& head, const std::vector<std::string_view>& words,
                                std::size_t at, const LogPlace& place) const {
    const std::string_view value = words[at + 1];
    if (!number_in<std::int64_t>(value)) {
      // Prose about offsets has no digits here.
      if (value.find_first_of("0123456789") == std::string_view::npos && value != "nan" &&
          value != "inf") {
        return std::nullopt;
      }
      place.fail("offset", value, "whole nanoseconds");
    }
    LogLine found = line_of(head, words, at, place);
    found.point.error_s = 1e-9 * finite_of(value, "offset", 1e9 * kLargestErrorS, place);
    found.locked = at + 2 >= words.size() || (words[at + 2] != "s0" && words[at + 2] != "s1");
    return found;
  }

  std::optional<LogLine> summary(const Head& head, const std::vector<std::string_view>& words,
                                 std::size_t at, const LogPlace& place) const {
    LogLine found = line_of(head, words, at, place);
    const double largest_ns = 1e9 * kLargestErrorS;
    found.point.error_s = 1e-9 * finite_of(words[at + 1], "rms", largest_ns, place);
    found.largest_s = 1e-9 * finite_of(words[at + 3], "max", largest_ns, place);
    return found;
  }

  JournalText journal_;
  std::uint64_t others_ = 0;
};

}  // namespace

std::unique_ptr<LogLines> linuxptp_lines() { return std::make_unique<LinuxptpLines>(); }

}  // namespace simbench::evaluation
