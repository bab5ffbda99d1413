// Reads what ptp4l and phc2sys print, alone or behind the head of a syslog or a journal.
#include <fmt/format.h>

#include <algorithm>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/number_in.h"

namespace simbench::evaluation {
namespace {

constexpr double kLargestErrorNs = 1e9 * kLargestErrorS;

// The text between brackets at the beginning, which is taken off with the blanks behind it.
std::optional<std::string_view> take_brackets(std::string_view& rest) {
  if (!rest.starts_with('[')) return std::nullopt;
  const std::size_t end = rest.find(']');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view inside = rest.substr(1, end - 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(' ', end + 1), rest.size()));
  return inside;
}

bool is_stamp(std::string_view text) { return text.find('.') != std::string_view::npos; }

class LinuxptpLines final : public LogLines {
 public:
  explicit LinuxptpLines(const char* program) : program_(program) {}

  const char* format() const override { return program_; }

  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::optional<std::string_view> after = behind_program(line);
    if (!after) {
      ++others_;
      return std::nullopt;
    }
    std::string_view rest = *after;
    const std::string_view stamp = take_stamp(rest, place);
    const char* begin = rest.data();
    take_brackets(rest);  // the name of the configuration, part of that of the series
    const std::vector<std::string_view> words = words_of(rest);
    for (std::size_t i = 0; i < words.size() && i < 2; ++i) {
      if (words[i] == "rms" && words.size() > i + 2 && words[i + 2] == "max") {
        place.fail("offset", rest,
                   "a line for each update; a summary has no series, so set summary_interval (of "
                   "ptp4l) or -u (of phc2sys) to 0");
      }
    }
    for (std::size_t i = 1; i <= 3 && i + 1 < words.size(); ++i) {
      if (words[i] != "offset") continue;
      const char* end = words[i - 1].data() + words[i - 1].size();
      return measured({begin, static_cast<std::size_t>(end - begin)}, words, i + 1, stamp, place);
    }
    return std::nullopt;
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (others_ > 0) {
      notes.push_back(
          fmt::format("{} of other programs than {} left out", counted(others_, "line"), program_));
    }
    if (unlocked_ > 0) {
      notes.push_back(fmt::format("{} before the servo locked (s0, s1) among those taken",
                                  counted(unlocked_, "point")));
    }
    return notes;
  }

 private:
  // "[5374018.735]: ...", ": [5374018.735] ..." or "[process]: [5374018.735] ...".
  std::optional<std::string_view> behind_program(std::string_view line) const {
    const std::string_view program = program_;
    for (std::size_t at = 0; (at = line.find(program, at)) != std::string_view::npos;) {
      at += program.size();
      const std::string_view rest = line.substr(at);
      if (rest.starts_with('[') || rest.starts_with(": [")) return rest;
    }
    return std::nullopt;
  }

  std::string_view take_stamp(std::string_view& rest, const LogPlace& place) const {
    const std::string_view whole = rest;
    std::optional<std::string_view> stamp = take_brackets(rest);
    if (rest.starts_with(':')) {
      rest.remove_prefix(std::min(rest.find_first_not_of(": "), rest.size()));
    }
    if (!stamp || !is_stamp(*stamp)) stamp = take_brackets(rest);
    if (!stamp || !is_stamp(*stamp) || !microseconds_of(*stamp)) {
      place.fail("time", whole,
                 fmt::format("seconds in brackets, such as {}[5374018.735]", program_));
    }
    return *stamp;
  }

  std::optional<LogLine> measured(std::string_view series,
                                  const std::vector<std::string_view>& words, std::size_t at,
                                  std::string_view stamp, const LogPlace& place) {
    if (!number_in<std::int64_t>(words[at])) {
      // Prose about offsets has no digits here.
      if (words[at].find_first_of("0123456789") == std::string_view::npos && words[at] != "nan" &&
          words[at] != "inf") {
        return std::nullopt;
      }
      place.fail("offset", words[at], "whole nanoseconds");
    }
    const double offset_ns = finite_of(words[at], "offset", kLargestErrorNs, place);
    const bool unlocked = at + 1 < words.size() && (words[at + 1] == "s0" || words[at + 1] == "s1");
    if (unlocked) ++unlocked_;
    return LogLine{series, {*microseconds_of(stamp), 1e-9 * offset_ns}};
  }

  const char* program_;
  std::uint64_t others_ = 0;
  std::uint64_t unlocked_ = 0;
};

}  // namespace

std::unique_ptr<LogLines> linuxptp_lines(const char* program) {
  return std::make_unique<LinuxptpLines>(program);
}

}  // namespace simbench::evaluation
