// A duration that a user states with its unit: "1ms", "50us", "2.5s".
//
//   const std::optional<double> limit_s = seconds_in("1ms");
#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "recording/number_in.h"

namespace simbench {

// How messages name what is allowed.
inline constexpr const char* kDurationAllowed = "a time above 0 with its unit (s, ms, us, ns)";

// A number above 0 with a unit of time, in seconds; nothing for another text.
inline std::optional<double> seconds_in(std::string_view text) {
  constexpr std::pair<std::string_view, double> kTimeUnits[] = {
      {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"s", 1}};
  for (const auto& [unit, seconds] : kTimeUnits) {
    if (!text.ends_with(unit)) continue;
    const auto value = number_in<double>(text.substr(0, text.size() - unit.size()));
    return value && *value > 0 ? std::optional(*value * seconds) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace simbench
