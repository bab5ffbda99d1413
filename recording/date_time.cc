#include "recording/date_time.h"

#include <cstdint>
#include <string>

#include "recording/number_in.h"
#include "recording/stamp_unit.h"

namespace simbench {
namespace {

// The number of `count` digits at the beginning of a text, which are taken off.
std::optional<int> take_digits(std::string_view& text, std::size_t count) {
  if (text.size() < count) return std::nullopt;
  int value = 0;
  for (const char c : text.substr(0, count)) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, char letter) {
  if (!text.starts_with(letter)) return false;
  text.remove_prefix(1);
  return true;
}

// The distance of a zone from UTC; nothing for what is none.
std::optional<std::chrono::minutes> zone_in(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  if (text.empty() || text == "Z" || text == "z" || text == "UTC") return std::chrono::minutes(0);
  const bool west = text.front() == '-';
  if (!west && text.front() != '+') return std::nullopt;
  text.remove_prefix(1);
  const std::optional<int> hours = take_digits(text, 2);
  if (!hours || *hours > 14) return std::nullopt;
  take(text, ':');
  const std::optional<int> minutes = text.empty() ? 0 : take_digits(text, 2);
  if (!minutes || *minutes > 59 || !text.empty()) return std::nullopt;
  const std::chrono::minutes distance(*hours * 60 + *minutes);
  return west ? -distance : distance;
}

std::optional<Nanoseconds> second_in(std::string_view text) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  const std::optional<int> whole = take_digits(text, 2);
  if (!whole || *whole > 60) return std::nullopt;
  std::int64_t ns = *whole * kNsPerSecond;
  if (text.empty()) return Nanoseconds(ns);
  if (!take(text, '.') && !take(text, ',')) return std::nullopt;
  if (text.empty()) return std::nullopt;
  std::int64_t place = kNsPerSecond;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    place /= 10;
    ns += place * (c - '0');
  }
  return Nanoseconds(ns);
}

}  // namespace

std::optional<std::chrono::sys_days> day_in(std::string_view text) {
  const std::optional<int> year = take_digits(text, 4);
  if (!year || *year < 1900 || *year > 2261 || !take(text, '-')) return std::nullopt;
  const std::optional<int> month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const std::optional<int> day = take_digits(text, 2);
  if (!day || !text.empty()) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days{date};
}

std::optional<Nanoseconds> time_of_day_in(std::string_view text) {
  const std::optional<int> hour = take_digits(text, 2);
  if (!hour || *hour > 23 || !take(text, ':')) return std::nullopt;
  const std::optional<int> minute = take_digits(text, 2);
  if (!minute || *minute > 59 || !take(text, ':')) return std::nullopt;
  const std::optional<Nanoseconds> second = second_in(text);
  if (!second) return std::nullopt;
  return std::chrono::hours(*hour) + std::chrono::minutes(*minute) + *second;
}

std::optional<Nanoseconds> date_time_in(std::string_view text) {
  constexpr std::size_t kDay = 10;
  if (text.size() < kDay + 9 || (text[kDay] != 'T' && text[kDay] != ' ')) return std::nullopt;
  const auto day = day_in(text.substr(0, kDay));
  if (!day) return std::nullopt;
  const std::string_view rest = text.substr(kDay + 1);
  const std::size_t end = std::min(rest.find_first_not_of("0123456789:.,"), rest.size());
  const auto time = time_of_day_in(rest.substr(0, end));
  const auto zone = zone_in(rest.substr(end));
  if (!time || !zone) return std::nullopt;
  return day->time_since_epoch() + *time - *zone;
}

}  // namespace simbench
