#include "recording/text_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "recording/number_in.h"

namespace simbench {

std::string quoted_bytes(std::string_view bytes) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char byte : bytes.substr(0, kLongest)) {
    if (byte >= ' ' && byte <= '~') {
      text += byte;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    }
  }
  return text += bytes.size() > kLongest ? "...'" : "'";
}

namespace {

// The length of the UTF-8 character at the begin of `text` that is no control character; else 0.
std::size_t printable_length(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool control = first == 0xc2 && second < 0xa0;  // C1
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool no_character = (first == 0xed && second >= 0xa0) || (first == 0xf4 && second >= 0x90);
  return control || overlong || no_character ? 0 : length;
}

}  // namespace

std::string printable_name(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t length = printable_length(name);
    if (length == 0) {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(name.front()));
    } else {
      text += name.substr(0, length);
    }
    name.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return text;
}

std::string printable_lines(std::string_view text) {
  std::string lines;
  for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos;) {
    lines += printable_name(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return lines + printable_name(text);
}

void append_number(std::string& line, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  line.append(digits, end);
}

void append_escaped(std::string& line, std::string_view text) {
  for (const char c : text) {
    switch (c) {
      case '\\':
      case ',':
        line += '\\';
        line += c;
        break;
      case '\n':
        line += "\\n";
        break;
      case '\r':
        line += "\\r";
        break;
      default:
        line += c;
    }
  }
}

double FieldReader::finite(const char* name) {
  const std::string_view field = next(name);
  const std::optional<double> value = number_in<double>(field);
  std::string canonical;
  if (value && std::isfinite(*value)) append_number(canonical, *value);
  if (canonical != field || field.empty()) fail(name, "a number in its shortest form");
  return *value;
}

std::string FieldReader::text(const char* name) {
  if (done_) fail_missing(name);
  ++column_;
  field_ = rest_;
  rest_ = {};
  done_ = true;
  std::string text;
  text.reserve(field_.size());
  for (std::size_t i = 0; i < field_.size(); ++i) {
    char c = field_[i];
    if (c == ',' || c == '\n' || c == '\r') fail(name, "\\, \\n and \\r for comma and line ends");
    if (c == '\\') {
      c = i + 1 < field_.size() ? field_[++i] : ' ';
      if (c == 'n' || c == 'r') {
        c = c == 'n' ? '\n' : '\r';
      } else if (c != '\\' && c != ',') {
        fail(name, "after a backslash: backslash, comma, n or r");
      }
    }
    text += c;
  }
  return text;
}

void FieldReader::end() const {
  if (done_) return;
  throw TextFieldError(fmt::format("column {}: found {}, allowed: {} columns", column_ + 1,
                                   quoted_bytes(rest_), column_));
}

void FieldReader::fail(const char* name, std::string_view allowed) const {
  throw TextFieldError(fmt::format("column {} ({}): found {}, allowed: {}", column_, name,
                                   quoted_bytes(field_), allowed));
}

void FieldReader::fail_missing(const char* name) const {
  throw TextFieldError(
      fmt::format("column {} ({}): missing, the line ends before it", column_ + 1, name));
}

void FieldReader::fail_range(const char* name, const std::string& from,
                             const std::string& to) const {
  fail(name, fmt::format("a whole number from {} to {}", from, to));
}

namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Numbers with an exponent, which nobody writes for stamps that need every digit.
std::optional<Nanoseconds> parse_scientific(std::string_view text, std::int64_t largest_ms) {
  const std::optional<double> value = number_in<double>(text);
  if (!value || !(std::abs(*value) <= static_cast<double>(largest_ms))) return std::nullopt;
  return from_ms(*value);
}

}  // namespace

std::optional<Nanoseconds> parse_ms(std::string_view text, std::int64_t largest_ms) {
  const bool negative = !text.empty() && text.front() == '-';
  std::size_t at = negative ? 1 : 0;
  const std::size_t first = at;
  std::int64_t whole = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    whole = whole * 10 + (text[at] - '0');
    if (whole > largest_ms) return std::nullopt;
  }
  std::size_t digits = at - first;
  std::int64_t fraction = 0;
  if (at < text.size() && text[at] == '.') {
    std::int64_t place = kNsPerMs;
    for (++at; at < text.size() && is_digit(text[at]); ++at, ++digits) {
      place /= 10;
      fraction += place * (text[at] - '0');
      if (place == 0) {  // the first digit that does not count decides about rounding
        if (text[at] >= '5') ++fraction;
        while (at + 1 < text.size() && is_digit(text[at + 1])) ++at;
      }
    }
  }
  if (digits == 0) return std::nullopt;
  if (at != text.size()) return parse_scientific(text, largest_ms);
  if (whole == largest_ms && fraction > 0) return std::nullopt;
  const std::int64_t ns = whole * kNsPerMs + fraction;
  return Nanoseconds(negative ? -ns : ns);
}

std::string ms_text(Nanoseconds time) {
  const std::int64_t ns = time.count();
  const std::int64_t whole = ns / kNsPerMs;
  const std::string fraction = std::to_string(std::abs(ns % kNsPerMs));
  std::string text = ns < 0 && whole == 0 ? "-" : "";
  text += std::to_string(whole);
  text += '.';
  text.append(6 - fraction.size(), '0');
  return text += fraction;
}

}  // namespace simbench
