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

// The UTF-8 character at the begin of a text; of no length where there is none.
struct Character {
  std::size_t length = 0;
  char32_t code = 0;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return {};
  char32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  return overlong || surrogate || code > 0x10ffff ? Character{} : Character{length, code};
}

// Whether it is obeyed, or never seen, instead of shown.
bool is_obeyed(char32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e ||
         code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2060 && code <= 0x206f) || code == 0xfeff;
}

// Replaces what is obeyed or no UTF-8 (a byte at a time) by escaped(bytes, code).
template <class Escaped>
std::string with_escapes(std::string_view text, const Escaped& escaped) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_character(text);
    const std::string_view bytes = text.substr(0, std::max<std::size_t>(next.length, 1));
    if (next.length == 0 || is_obeyed(next.code)) {
      shown += escaped(bytes, next.code);
    } else {
      shown += bytes;
    }
    text.remove_prefix(bytes.size());
  }
  return shown;
}

}  // namespace

std::string printable_name(std::string_view name) {
  return with_escapes(name, [](std::string_view bytes, char32_t) {
    std::string text;
    for (const char byte : bytes)
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    return text;
  });
}

std::string printable_json(std::string_view json) {
  return with_escapes(json, [](std::string_view bytes, char32_t code) {
    if (bytes == "\n") return std::string(bytes);  // between values: strings have it escaped
    return fmt::format("\\u{:04x}", code == 0 ? 0xfffd : static_cast<unsigned>(code));
  });
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

std::string_view take_cell(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t comma = std::min(line.find(','), line.size());
  std::string_view cell = line.substr(0, comma);
  line.remove_prefix(std::min(comma + 1, line.size()));
  cell.remove_prefix(std::min(cell.find_first_not_of(kBlank), cell.size()));
  return cell.substr(0, cell.find_last_not_of(kBlank) + 1);
}

std::string csv_cell(std::string_view unchecked) {
  std::string text = printable_name(unchecked);
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

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
  return unescaped(name);
}

std::string FieldReader::inner_text(const char* name) {
  std::size_t comma = 0;
  while (comma < rest_.size() && rest_[comma] != ',') comma += rest_[comma] == '\\' ? 2 : 1;
  if (done_ || comma >= rest_.size()) fail_missing(name);
  ++column_;
  field_ = rest_.substr(0, comma);
  rest_.remove_prefix(comma + 1);
  return unescaped(name);
}

std::string FieldReader::unescaped(const char* name) const {
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
