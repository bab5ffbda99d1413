// Milliseconds written as a decimal number, to the exact nanosecond.
//
// A double would do for hours, but not for stamps that count from 1970: their last bits are worth
// 0.2 us.
//
//   parse_ms("12.3456789")   // 12'345'679 ns: digits beyond the sixth are rounded
#ifndef SIMBENCH_RECORDING_DECIMAL_H_
#define SIMBENCH_RECORDING_DECIMAL_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algorithms/ports/time.h"

namespace simbench {

// Nothing if the text is no number, or one of more than `largest_ms` (at most 9e12) either way.
// An exponent is allowed.
std::optional<Nanoseconds> parse_ms(std::string_view text, std::int64_t largest_ms);

// With six decimals: "12.345679".
std::string ms_text(Nanoseconds time);

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_DECIMAL_H_
