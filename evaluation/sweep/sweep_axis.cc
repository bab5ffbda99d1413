#include "evaluation/sweep/sweep_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr double kTolerance = 1e-9;  // of a step: how near the stop the last value must be

[[noreturn]] void fail(const std::string& axis, const std::string& problem) {
  throw scenarios::InputError(fmt::format("--sweep {}: {}", axis, problem));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string::npos;
       end = text.find(separator, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// How many decimals a number is written with: 0.25 has 2, 3e-4 has 4.
int decimals_of(const std::string& text) {
  const std::size_t exponent_at = text.find_first_of("eE");
  const std::string mantissa = text.substr(0, exponent_at);
  const std::size_t point = mantissa.find('.');
  const auto digits =
      point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  int exponent = 0;
  if (exponent_at != std::string::npos) {
    const char* begin = text.data() + exponent_at + 1;
    if (*begin == '+') ++begin;
    std::from_chars(begin, text.data() + text.size(), exponent);
  }
  return std::max(0, digits - exponent);
}

// start + i * step. With few decimals the sum is made of whole numbers, which are exact, and their
// quotient by a power of ten is the double nearest to the decimal.
class Range {
 public:
  Range(const std::string& start, const std::string& step)
      : start_(*number_of(start)), step_(*number_of(step)) {
    constexpr int kExactPowersOfTen = 22;
    const int decimals = std::max(decimals_of(start), decimals_of(step));
    if (decimals <= kExactPowersOfTen) scale_ = std::pow(10.0, decimals);
  }

  double value(std::size_t i) const {
    constexpr double kExactIntegers = 9007199254740992.0;  // 2^53
    const auto steps = static_cast<double>(i);
    const double plain = start_ + steps * step_;
    if (std::fabs(plain) * scale_ > kExactIntegers) return plain;
    const double whole = std::round(start_ * scale_) + steps * std::round(step_ * scale_);
    return whole / scale_;
  }

 private:
  double start_;
  double step_;
  double scale_ = 1e300;  // none that would be exact
};

std::vector<std::string> range_values(const std::string& axis, const std::string& text,
                                      const std::vector<std::string>& parts) {
  const auto allowed = "allowed start:stop:step, as in 0.1:5:0.1";
  if (parts.size() != 3) fail(axis, fmt::format("found '{}', {}", text, allowed));
  for (const std::string& part : parts) {
    if (!number_of(part)) fail(axis, fmt::format("found '{}' in a range, {}", part, allowed));
  }
  const double start = *number_of(parts[0]);
  const double stop = *number_of(parts[1]);
  const double step = *number_of(parts[2]);
  if (step == 0) fail(axis, fmt::format("the range {} has no end: its step is 0", text));
  const double steps = (stop - start) / step;
  if (steps < -kTolerance) {
    fail(axis, fmt::format("the range {} is empty: from {} steps of {} do not lead to {}", text,
                           parts[0], parts[2], parts[1]));
  }
  if (!(steps < kMostSteps)) {
    fail(axis, fmt::format("the range {} has {:.3g} values, allowed: at most {}", text, steps + 1,
                           kMostSteps));
  }
  const Range range(parts[0], parts[2]);
  std::vector<std::string> values;
  const auto last = static_cast<std::size_t>(std::floor(steps + kTolerance));
  for (std::size_t i = 0; i <= last; ++i) values.push_back(fmt::format("{}", range.value(i)));
  return values;
}

std::vector<std::string> list_values(const std::string& axis, const std::string& text) {
  std::vector<std::string> values = split(text, ',');
  for (std::string& value : values) {
    if (value.empty()) fail(axis, "found an empty value, allowed: values with a comma between two");
    if (value.find_first_of("[]{}") != std::string::npos) {
      fail(axis, fmt::format("found '{}', allowed: numbers, words, true, false", value));
    }
    const bool is_whole = value.find_first_not_of("0123456789") == std::string::npos;
    if (is_whole) continue;  // one beyond 2^53 would change
    if (const std::optional<double> number = number_of(value)) value = fmt::format("{}", *number);
  }
  return values;
}

// "/pointer=values"
void add_pointer(const std::string& axis, const std::string& text, SweepAxis& result) {
  const std::size_t equals = text.find('=');
  if (text.empty() || text.front() != '/' || equals == std::string::npos) {
    fail(axis, fmt::format("found '{}', allowed: /json/pointer=start:stop:step or "
                           "/json/pointer=value,value",
                           text));
  }
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> parts = split(values, ':');
  const bool is_range = parts.size() > 1 && values.find(',') == std::string::npos &&
                        values.find_first_of("0123456789+-.") == 0;
  result.pointers.push_back(text.substr(0, equals));
  result.values.push_back(is_range ? range_values(axis, values, parts) : list_values(axis, values));
  std::set<std::string> seen;
  for (const std::string& value : result.values.back()) {
    if (!seen.insert(value).second) fail(axis, fmt::format("found the value {} twice", value));
  }
}

}  // namespace

SweepAxis parse_axis(const std::string& text) {
  SweepAxis axis;
  std::size_t begin = 0;
  for (std::size_t end = text.find("+/"); end != std::string::npos; end = text.find("+/", begin)) {
    add_pointer(text, text.substr(begin, end - begin), axis);
    begin = end + 1;
  }
  add_pointer(text, text.substr(begin), axis);
  for (std::size_t i = 1; i < axis.pointers.size(); ++i) {
    if (axis.values[i].size() == axis.steps()) continue;
    fail(text,
         fmt::format("{} has {} values and {} has {}; in lockstep they need equally many",
                     axis.pointers[0], axis.steps(), axis.pointers[i], axis.values[i].size()));
  }
  return axis;
}

}  // namespace simbench::evaluation
