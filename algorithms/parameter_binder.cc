#include "algorithms/parameter_binder.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

struct TimeUnit {
  const char* suffix;
  double ns;
  Nanoseconds (*from)(double);
};

constexpr std::array<TimeUnit, 4> kTimeUnits = {{
    {"_us", 1e3, from_us},
    {"_ms", 1e6, from_ms},
    {"_s", 1e9, from_seconds},
    {"_hours", 3600e9, [](double hours) { return from_ms(hours * 3600e3); }},
}};

}  // namespace

ParameterBinder& ParameterBinder::time_span(const std::string& name, Nanoseconds& member,
                                            double low, double high, const std::string& meaning,
                                            const std::string& source) {
  const auto* const unit = std::ranges::find_if(
      kTimeUnits, [&name](const TimeUnit& each) { return name.ends_with(each.suffix); });
  SIMBENCH_ASSERT(unit != kTimeUnits.end(), "a span of time has its unit in its name");
  double value = to_ns(member) / unit->ns;
  exchange(value, name, low, high, meaning, source);
  const Nanoseconds span = unit->from(value);
  SIMBENCH_ASSERT(values_ != nullptr || span == member, "a default reads as another value");
  member = span;
  return *this;
}

ParameterBinder& ParameterBinder::scaled(const std::string& name, double& member, double factor,
                                         double low, double high, const std::string& meaning,
                                         const std::string& source) {
  double value = member / factor;
  exchange(value, name, low, high, meaning, source);
  SIMBENCH_ASSERT(values_ != nullptr || value * factor == member,
                  "a default reads as another value");
  member = value * factor;
  return *this;
}

ParameterBinder& ParameterBinder::log2_seconds(const std::string& name, Nanoseconds& member,
                                               double low, double high, const std::string& meaning,
                                               const std::string& source) {
  double value = std::log2(to_ns(member) / 1e9);
  exchange(value, name, low, high, meaning, source);
  const Nanoseconds span = from_seconds(std::exp2(value));
  SIMBENCH_ASSERT(values_ != nullptr || span == member, "a default reads as another value");
  member = span;
  return *this;
}

ParameterBinder& ParameterBinder::flag(const std::string& name, bool& member,
                                       const std::string& meaning, const std::string& source) {
  if (values_ != nullptr) {
    member = values_->flag(name);
  } else {
    specs_.push_back(
        {.name = name, .fallback = member, .choices = {}, .meaning = meaning, .source = source});
  }
  return *this;
}

ParameterBinder& ParameterBinder::not_below(const std::string& other) {
  if (values_ == nullptr) specs_.back().not_below = other;
  return *this;
}

void ParameterBinder::exchange(double& value, const std::string& name, double low, double high,
                               const std::string& meaning, const std::string& source) {
  if (values_ != nullptr) {
    value = values_->number(name);
    return;
  }
  SIMBENCH_ASSERT(value >= low && value <= high, "a default is out of its range");
  specs_.push_back({.name = name,
                    .fallback = value,
                    .low = low,
                    .high = high,
                    .choices = {},
                    .meaning = meaning,
                    .source = source});
}

std::string ParameterBinder::word_of(const std::string& name, std::vector<std::string> choices,
                                     std::size_t held, const std::string& meaning,
                                     const std::string& source) {
  if (values_ != nullptr) return values_->text(name);
  SIMBENCH_ASSERT(held < choices.size(), "a default has no word");
  std::string word = choices[held];
  specs_.push_back({.name = name,
                    .fallback = word,
                    .choices = std::move(choices),
                    .meaning = meaning,
                    .source = source});
  return word;
}

}  // namespace simbench
