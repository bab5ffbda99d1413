#include "recording/text_fields.h"

#include <fmt/format.h>

#include <cmath>

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
  const char* end = field.data() + field.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  std::string canonical;
  if (error == std::errc() && stop == end && std::isfinite(value)) append_number(canonical, value);
  if (canonical != field || field.empty()) fail(name, "a number in its shortest form");
  return value;
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

}  // namespace simbench
