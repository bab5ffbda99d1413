#include "recording/stamp_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <utility>
#include <vector>

#include "recording/number_in.h"

namespace simbench {
namespace {

struct UnitSpelling {
  std::string_view name;  // in small letters
  StampUnit unit;
};

constexpr auto kSpellings = std::to_array<UnitSpelling>({
    {"s", kSecondUnit},
    {"sec", kSecondUnit},
    {"secs", kSecondUnit},
    {"second", kSecondUnit},
    {"seconds", kSecondUnit},
    {"ms", kMillisecondUnit},
    {"msec", kMillisecondUnit},
    {"msecs", kMillisecondUnit},
    {"millis", kMillisecondUnit},
    {"millisec", kMillisecondUnit},
    {"millisecond", kMillisecondUnit},
    {"milliseconds", kMillisecondUnit},
    {"us", kMicrosecondUnit},
    {"usec", kMicrosecondUnit},
    {"usecs", kMicrosecondUnit},
    {"micros", kMicrosecondUnit},
    {"microsec", kMicrosecondUnit},
    {"microsecond", kMicrosecondUnit},
    {"microseconds", kMicrosecondUnit},
    {"ns", kNanosecondUnit},
    {"nsec", kNanosecondUnit},
    {"nsecs", kNanosecondUnit},
    {"nanos", kNanosecondUnit},
    {"nanosec", kNanosecondUnit},
    {"nanosecond", kNanosecondUnit},
    {"nanoseconds", kNanosecondUnit},
    {"ps", kPicosecondUnit},
    {"psec", kPicosecondUnit},
    {"picosecond", kPicosecondUnit},
    {"picoseconds", kPicosecondUnit},
    {"min", {60, 1}},
    {"minutes", {60, 1}},
    {"h", {3600, 1}},
    {"hours", {3600, 1}},
    {"days", {86'400, 1}},
    {"mjd", {86'400, 1}},
});

constexpr std::array<StampUnit, 4> kUsualUnits = {kSecondUnit, kMillisecondUnit, kMicrosecondUnit,
                                                  kNanosecondUnit};

constexpr auto kFrequencies = std::to_array<UnitSpelling>({
    {"hz", kSecondUnit},
    {"khz", kMillisecondUnit},
    {"mhz", kMicrosecondUnit},
    {"ghz", kNanosecondUnit},
});

// Small letters, and u for both signs of micro.
std::string plain(std::string_view text) {
  std::string letters;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view pair = text.substr(i, 2);
    if (pair == "\xc2\xb5" || pair == "\xce\xbc") {
      letters += 'u';
      ++i;
    } else {
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
    }
  }
  return letters;
}

template <class Spellings>
std::optional<StampUnit> spelled(std::string_view letters, const Spellings& spellings) {
  const auto found = std::ranges::find(spellings, letters, &UnitSpelling::name);
  if (found == spellings.end()) return std::nullopt;
  return found->unit;
}

std::optional<StampUnit> unit_of_word(std::string_view word) {
  return spelled(plain(word), kSpellings);
}

// Words end where small letters end and capitals begin ("offsetNs"), too.
std::vector<std::string_view> words_of_heading(std::string_view heading) {
  std::vector<std::string_view> words;
  const auto letter = [&](std::size_t at) {
    const auto c = static_cast<unsigned char>(heading[at]);
    return std::isalnum(c) != 0 || c >= 0x80;
  };
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= heading.size(); ++at) {
    const bool ends = at == heading.size() || !letter(at);
    const bool turns = !ends && at > begin &&
                       std::isupper(static_cast<unsigned char>(heading[at])) &&
                       std::islower(static_cast<unsigned char>(heading[at - 1]));
    if (!ends && !turns) continue;
    if (at > begin) words.push_back(heading.substr(begin, at - begin));
    begin = ends ? at + 1 : at;
  }
  return words;
}

std::optional<StampUnit> unit_in_brackets(std::string_view heading) {
  for (const std::string_view brackets : {"()", "[]"}) {
    const std::size_t open = heading.rfind(brackets[0]);
    const std::size_t close = heading.find(brackets[1], open == std::string_view::npos ? 0 : open);
    if (open == std::string_view::npos || close == std::string_view::npos) continue;
    if (const auto unit = unit_named(heading.substr(open + 1, close - open - 1))) return unit;
  }
  return std::nullopt;
}

std::optional<StampUnit> scaled(const StampUnit& unit, std::int64_t numerator,
                                std::int64_t denominator) {
  __extension__ using Wide = __int128;
  Wide top = static_cast<Wide>(unit.numerator) * numerator;
  Wide bottom = static_cast<Wide>(unit.denominator) * denominator;
  Wide a = top;
  for (Wide b = bottom; b != 0;) a = std::exchange(b, a % b);
  top /= a;
  bottom /= a;
  constexpr Wide kMost = 1'000'000'000'000'000'000;
  if (top <= 0 || top > kMost || bottom > kMost) return std::nullopt;
  return StampUnit{static_cast<std::int64_t>(top), static_cast<std::int64_t>(bottom)};
}

// A number in a text as mantissa * 10^exponent; 36 digits at most count.
struct Decimal {
  __extension__ unsigned __int128 mantissa = 0;
  int exponent = 0;
  bool negative = false;
};

std::optional<Decimal> decimal_of(std::string_view text) {
  constexpr int kMostDigits = 36;
  Decimal number;
  if (text.starts_with('-') || text.starts_with('+')) {
    number.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  int digits = 0;
  bool any = false;
  bool fraction = false;
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (c < '0' || c > '9') break;
    any = true;
    if (digits < kMostDigits) {
      number.mantissa = number.mantissa * 10 + static_cast<unsigned>(c - '0');
      if (number.mantissa != 0) ++digits;
      if (fraction) --number.exponent;
    } else if (!fraction) {
      ++number.exponent;
    }
  }
  if (!any) return std::nullopt;
  if (at == text.size()) return number;
  if (text[at] != 'e' && text[at] != 'E') return std::nullopt;
  std::string_view power = text.substr(at + 1);
  if (power.starts_with('+')) power.remove_prefix(1);
  const std::optional<int> exponent = number_in<int>(power);
  if (!exponent || *exponent < -400 || *exponent > 400) return std::nullopt;
  number.exponent += *exponent;
  return number;
}

}  // namespace

std::optional<StampUnit> unit_named(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;
  const auto take_number = [&](std::int64_t& number) {
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    return true;
  };
  if (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    if (!take_number(numerator)) return std::nullopt;
    if (text.starts_with('/')) {
      text.remove_prefix(1);
      if (!take_number(denominator)) return std::nullopt;
    }
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  const std::string name = plain(text);
  if (const auto unit = spelled(name, kSpellings)) return scaled(*unit, numerator, denominator);
  if (const auto unit = spelled(name, kFrequencies)) return scaled(*unit, denominator, numerator);
  return std::nullopt;
}

std::optional<StampUnit> heading_unit(std::string_view heading) {
  if (const auto unit = unit_in_brackets(heading)) return unit;
  const std::vector<std::string_view> words = words_of_heading(heading);
  std::optional<StampUnit> only;
  for (const std::string_view word : words) {
    const bool is_last = words.size() > 1 && word.data() == words.back().data();
    const auto unit = word.size() > 1 || is_last ? unit_of_word(word) : std::nullopt;
    if (!unit) continue;
    if (only) return std::nullopt;  // a rate
    only = unit;
  }
  return only;
}

std::string unit_text(const StampUnit& unit) {
  for (const StampUnit& base :
       {kSecondUnit, kMillisecondUnit, kMicrosecondUnit, kNanosecondUnit, kPicosecondUnit}) {
    if (unit.denominator != base.denominator) continue;
    const auto name = std::ranges::find(kSpellings, base, &UnitSpelling::unit)->name;
    return unit.numerator == 1 ? std::string(name) : fmt::format("{} {}", unit.numerator, name);
  }
  return fmt::format("{}/{} s", unit.numerator, unit.denominator);
}

std::optional<StampUnit> epoch_unit(double number) {
  constexpr double kFrom = 6.3e8;
  constexpr double kUntil = 4.1e9;
  for (const StampUnit& unit : kUsualUnits) {
    const double seconds = number * unit.seconds();
    if (seconds > kFrom && seconds < kUntil) return unit;
  }
  return std::nullopt;
}

std::optional<StampUnit> frame_rate_unit(double distance) {
  for (const StampUnit& unit : kUsualUnits) {
    const double seconds = distance * unit.seconds();
    if (seconds > 1e-3 && seconds <= 1) return unit;
  }
  return std::nullopt;
}

std::optional<Nanoseconds> time_in(std::string_view text, const StampUnit& unit) {
  __extension__ using Wide = unsigned __int128;
  constexpr auto kMost = static_cast<Wide>(kLargestTime.count());
  std::optional<Decimal> number = decimal_of(text);
  if (!number) return std::nullopt;
  if (number->mantissa == 0) return Nanoseconds(0);
  // mantissa * 10^exponent * numerator / denominator seconds, in nanoseconds.
  int exponent = number->exponent + 9;
  Wide top = number->mantissa;
  Wide bottom = static_cast<Wide>(unit.denominator);
  while (bottom % 10 == 0) {
    bottom /= 10;
    --exponent;
  }
  // Trailing zeros and digits far below a nanosecond do not count.
  constexpr Wide kRoom = std::numeric_limits<Wide>::max() / 10;
  for (; exponent < 0 && (top % 10 == 0 || exponent < -20); ++exponent) top /= 10;
  const auto numerator = static_cast<Wide>(unit.numerator);
  if (top > kRoom / numerator) {
    for (; exponent < 0 && top > kRoom / numerator; ++exponent) top /= 10;
    if (top > kRoom / numerator) return std::nullopt;
  }
  top *= numerator;
  for (; exponent > 0; --exponent) {
    if (top > kRoom) return std::nullopt;
    top *= 10;
  }
  for (; exponent < 0; ++exponent) {
    if (bottom > kRoom) return Nanoseconds(0);
    bottom *= 10;
  }
  const Wide ns = top / bottom + (top % bottom >= bottom - top % bottom ? 1 : 0);
  if (ns > kMost) return std::nullopt;
  const auto count = static_cast<std::int64_t>(ns);
  return Nanoseconds(number->negative ? -count : count);
}

}  // namespace simbench
