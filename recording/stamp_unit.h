// Units of times in files of other programs: from a heading in any of the usual spellings, from an
// option, and the exact nanoseconds of a number in them.
//
//   heading_unit("offset_ns");     // ns; also offset_NS, offset (ns), offset:nsec, offsetNs,
//                                  // offset [µs], TE_usec, elapsed_msec ...
//   unit_named("8ns");             // ticks of 8 ns; also 90kHz, 1/30000s
//   time_in("0.25", *unit_named("us"));   // 250 ns
//
// A heading's unit is what stands in brackets, else the only one of its words that is a unit; a
// unit of one letter must be the last of several words, and two units are a rate (ns/s). Words end
// at anything but a letter or a digit, and where small letters end and capitals begin. Capitals do
// not matter.
//
// Complexity: linear in the text, without allocation but for headings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algorithms/ports/time.h"

namespace simbench {

// A unit is numerator/denominator seconds, in lowest terms.
struct StampUnit {
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;

  double seconds() const {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }
  friend bool operator==(const StampUnit&, const StampUnit&) = default;
};

inline constexpr StampUnit kSecondUnit{};
inline constexpr StampUnit kMillisecondUnit{1, 1000};
inline constexpr StampUnit kMicrosecondUnit{1, 1'000'000};
inline constexpr StampUnit kNanosecondUnit{1, 1'000'000'000};
inline constexpr StampUnit kPicosecondUnit{1, 1'000'000'000'000};

// "ns", "8 ns", "90kHz", "1/30000 s": the name, or a factor and a name; of frequencies the period.
std::optional<StampUnit> unit_named(std::string_view text);
std::optional<StampUnit> heading_unit(std::string_view heading);
// "ns", "us"; "8 ns" of a factor.
std::string unit_text(const StampUnit& unit);
// What unit_named() reads, for messages.
inline constexpr const char* kUnitsText = "s, ms, us, ns, ps, or ticks such as 8ns or 90kHz";

// The unit of a number that counts from 1970 (from 1990 to 2100), by its size; nothing for others.
std::optional<StampUnit> epoch_unit(double number);
// The only unit in which frames that are so far apart come 1 to 1000 times a second; nothing if
// there is none.
std::optional<StampUnit> frame_rate_unit(double distance);

// 292 years: 64 bits of nanoseconds, with room to round.
inline constexpr Nanoseconds kLargestTime{9'223'372'036'000'000'000};

// A decimal number with sign, point and exponent as these have them; nothing for any other text,
// and beyond kLargestTime either way. Digits below a nanosecond are rounded.
std::optional<Nanoseconds> time_in(std::string_view text, const StampUnit& unit);

}  // namespace simbench
