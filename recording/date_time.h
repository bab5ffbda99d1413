// Days and times of day in files of other programs, as nanoseconds since 1970.
//
//   date_time_in("2024-09-03T10:32:22.25Z");       // UTC
//   date_time_in("2024-09-03 10:32:22,25+02:00");  // of a zone
//   date_time_in("2011-09-26 13:02:25.964389445"); // without one: as if it were UTC
//
// Leap seconds (":60") are the first second of the next minute. Complexity: linear, no allocation.
// Source: ISO 8601, RFC 3339.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "algorithms/ports/time.h"

namespace simbench {

// "2024-09-03", from 1900 to 2261 (64 bits of nanoseconds).
std::optional<std::chrono::sys_days> day_in(std::string_view text);
// "10:32:22", "10:32:22.25", "10:32:22,25".
std::optional<Nanoseconds> time_of_day_in(std::string_view text);
// Both, with 'T' or a blank between them and, or not, a zone: Z, UTC, +02:00, +0200, +02.
std::optional<Nanoseconds> date_time_in(std::string_view text);

}  // namespace simbench
