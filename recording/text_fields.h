// The fields of a comma-separated line, strictly as they were written or as other programs write
// them, and milliseconds as exact decimal numbers.
//
//   std::string line = "poll";
//   append_field(line, poll.camera);
//
//   FieldReader fields(line);
//   fields.next("kind");
//   const auto camera = fields.whole<std::uint32_t>("camera");
//   fields.end();
//
//   std::string_view theirs = "1000, 00.0396100, -0.0000025";
//   const std::string_view count = take_cell(theirs);   // "1000"
//
//   csv_cell("a,b");   // "\"a,b\""
//
//   parse_ms("12.3456789", 1000);   // 12'345'679 ns: digits beyond the sixth are rounded
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "algorithms/ports/time.h"

namespace simbench {

class TextFieldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// For a message: in quotes, cut after 40 bytes, what is no printable ASCII as \xHH.
std::string quoted_bytes(std::string_view bytes);
// A name that a terminal, a table or a page shows and does not obey. Written as \xHH is what is no
// UTF-8, and what controls a terminal (C0, DEL, C1), the direction of text (U+061C, U+200E, U+200F,
// U+202A to U+202E, U+2066 to U+2069), its lines (U+2028, U+2029; U+0085 is of C1), or is never
// seen (U+2060 to U+206F, U+FEFF). The rest stays, also U+200B to U+200D: scripts need them for the
// shape of letters and for line breaks, and they neither reorder a text nor end a line.
std::string printable_name(std::string_view name);
// Keeps the line ends of text of several lines.
std::string printable_lines(std::string_view text);
// JSON text whose strings mean the same, with \uXXXX for those characters.
std::string printable_json(std::string_view json);

// The first cell of a line of commas, without the blanks around it; it is taken off the line. Empty
// at the end of the line.
std::string_view take_cell(std::string_view& line);

// A cell of a CSV, quoted where necessary (RFC 4180), with printable_name() of it; what is not
// finite is empty.
std::string csv_cell(std::string_view text);
std::string csv_cell(double value);

template <std::integral Number>
void append_number(std::string& line, Number value) {
  char digits[24];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  line.append(digits, end);
}
void append_number(std::string& line, double value);
void append_escaped(std::string& line, std::string_view text);

template <class Number>
void append_field(std::string& line, Number value) {
  line += ',';
  append_number(line, value);
}
template <class Base, class Duration>
void append_field(std::string& line, std::chrono::time_point<Base, Duration> time) {
  append_field(line, time.time_since_epoch().count());
}
// An empty field where there is none.
template <class Value>
void append_field(std::string& line, const std::optional<Value>& value) {
  if (value) {
    append_field(line, *value);
  } else {
    line += ',';
  }
}

// The number that is the whole of `text`.
template <std::integral Number>
bool read_whole(std::string_view text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return false;
  const std::size_t first = text.front() == '-' ? 1 : 0;
  return text[first] != '0' || text.size() == 1;
}

// Reads back exactly what was written: a whole number has no plus sign, no needless zero and no
// "-0"; a double is finite and in the shortest form; a text has backslash, comma and line ends as
// \\ \, \n \r. A line that is read without an error is thus the one written for the same values.
//
// Errors: TextFieldError, "column 5 (counter): found '1x', allowed: ...". Any bytes are safe.
class FieldReader {
 public:
  // `line` must outlive this.
  explicit FieldReader(std::string_view line) : rest_(line) {}

  // The field at which the reader stands; `name` is for the message.
  std::string_view next(const char* name) {
    if (done_) fail_missing(name);
    ++column_;
    const std::size_t comma = rest_.find(',');
    field_ = rest_.substr(0, comma);
    done_ = comma == std::string_view::npos;
    rest_.remove_prefix(done_ ? rest_.size() : comma + 1);
    return field_;
  }

  template <std::integral Number>
  Number whole(const char* name) {
    next(name);
    return whole_of_field<Number>(name);
  }
  // Nothing if the field is empty.
  template <std::integral Number>
  std::optional<Number> optional_whole(const char* name) {
    if (next(name).empty()) return std::nullopt;
    return whole_of_field<Number>(name);
  }
  double finite(const char* name);
  // A text that is the last field of its line.
  std::string text(const char* name);
  // One that is followed by another field.
  std::string inner_text(const char* name);

  // Throws if there is another field.
  void end() const;
  bool at_end() const { return done_; }
  // Reads the rest of the line if that is `count` empty fields.
  bool take_empty(std::size_t count) {
    if (done_ || rest_.size() + 1 != count) return false;
    if (rest_.find_first_not_of(',') != std::string_view::npos) return false;
    rest_ = {};
    return done_ = true;
  }

  // About the field that was read last.
  [[noreturn]] void fail(const char* name, std::string_view allowed) const;

 private:
  template <std::integral Number>
  Number whole_of_field(const char* name) const {
    Number value{};
    if (!read_whole(field_, value)) {
      fail_range(name, std::to_string(std::numeric_limits<Number>::min()),
                 std::to_string(std::numeric_limits<Number>::max()));
    }
    return value;
  }
  // The field that was read last, as append_escaped() wrote it.
  std::string unescaped(const char* name) const;
  [[noreturn]] void fail_missing(const char* name) const;
  [[noreturn]] void fail_range(const char* name, const std::string& from,
                               const std::string& to) const;

  std::string_view rest_;
  std::string_view field_;
  std::size_t column_ = 0;
  bool done_ = false;
};

// Exact to the nanosecond, where a double loses 0.2 us on stamps that count from 1970. Nothing if
// the text is no number, or one of more than `largest_ms` (at most 9e12) either way. An exponent is
// allowed.
std::optional<Nanoseconds> parse_ms(std::string_view text, std::int64_t largest_ms);

// With six decimals: "12.345679".
std::string ms_text(Nanoseconds time);

}  // namespace simbench
