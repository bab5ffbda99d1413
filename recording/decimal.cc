#include "recording/decimal.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace simbench {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Numbers with an exponent, which nobody writes for stamps that need every digit.
std::optional<Nanoseconds> parse_scientific(std::string_view text, std::int64_t largest_ms) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool in_range = std::abs(value) <= static_cast<double>(largest_ms);
  if (error != std::errc() || stop != end || !in_range) return std::nullopt;
  return from_ms(value);
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
