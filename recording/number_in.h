// The number that all of a text is, as std::from_chars() reads it: without blanks or a plus sign,
// and whatever the locale.
//
//   const std::optional<double> value = number_in<double>("2.5e-3");
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace simbench {

// Nothing if the text is anything else, or beyond the type's range.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace simbench
