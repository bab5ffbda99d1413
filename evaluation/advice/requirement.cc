#include "evaluation/advice/requirement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "recording/number_in.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

// What stands for a metric of another name.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"error", "absolute_error"}, {"recall", "seed_recall"}, {"precision", "seed_precision"}};

std::string without_unit(std::string_view id) {
  for (const std::string_view unit : {"_per_s", "_ms", "_s", "_ppm"}) {
    if (id.ends_with(unit)) return std::string(id.substr(0, id.size() - unit.size()));
  }
  return std::string(id);
}

[[noreturn]] void refuse(const std::string& found, const std::string& allowed) {
  throw scenarios::InputError(
      fmt::format("--require: found '{}', allowed {}", scenarios::shown_text(found), allowed));
}

// The names that a requirement may have, without unit.
std::vector<std::string> requirement_names() {
  std::vector<std::string> names;
  for (const auto& [name, id] : kOtherNames) names.emplace_back(name);
  for (const Metric& metric : metrics()) {
    const std::string name = without_unit(metric.id);
    const auto is_other = [&name](const auto& pair) { return pair.second == name; };
    if (metric.is_series() && std::ranges::none_of(kOtherNames, is_other)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

const Metric& metric_named(const std::string& name) {
  std::string_view wanted = name;
  for (const auto& [other, id] : kOtherNames) {
    if (name == other) wanted = id;
  }
  for (const Metric& metric : metrics()) {
    if (metric.is_series() && (wanted == metric.id || wanted == without_unit(metric.id))) {
      return metric;
    }
  }
  refuse(name, fmt::format("a metric: {}", fmt::join(requirement_names(), ", ")));
}

// What a unit of the bound is in the metric's.
double factor_of(const Metric& metric, const std::string& unit, const std::string& text) {
  const std::map<std::string, double> times = {{"s", 1e3}, {"ms", 1}, {"us", 1e-3}, {"ns", 1e-6}};
  const std::map<std::string, double> shares = {{"%", 0.01}, {"", 1}};
  const std::map<std::string, double> plain = {{"", 1}};
  const std::map<std::string, double> rates = {{"ppm", 1}};
  const std::string_view of_metric = metric.unit;
  const bool is_time = of_metric == "ms" || of_metric == "s";
  const bool is_rate = of_metric == "ppm";
  const auto& units = is_time ? times : metric.is_share() ? shares : is_rate ? rates : plain;
  if (const auto found = units.find(unit); found != units.end()) {
    return of_metric == "s" ? found->second / times.at("s") : found->second;
  }
  refuse(text, fmt::format("{} with {}", metric.title,
                           is_time             ? "the unit s, ms, us or ns"
                           : metric.is_share() ? "% or as a share without unit"
                           : is_rate           ? "the unit ppm"
                                               : "no unit"));
}

void check_bound(const Requirement& requirement) {
  const Metric& metric = *requirement.metric;
  const bool wants_least = metric.better == Better::kHigher;
  if (metric.better != Better::kNeither && wants_least != requirement.is_least) {
    refuse(requirement.text, fmt::format("a bound that says something: {} {} is what one asks for",
                                         metric.title, wants_least ? ">" : "<"));
  }
  if (metric.is_share() && requirement.limit > 1) {
    refuse(requirement.text, "what a rig can meet: a share is at most 100 %");
  }
  const bool at_end =
      requirement.is_least ? metric.is_share() && requirement.limit == 1 : requirement.limit == 0;
  if (at_end && !requirement.takes_limit) {
    refuse(requirement.text, requirement.is_least ? "what a rig can meet: nothing is above 100 %"
                                                  : "what a rig can meet: nothing is below 0");
  }
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

// A number with its unit at the beginning of a text, which loses it: "5 mm at ..." is 5, "mm".
struct Quantity {
  double value = 0;
  std::string unit;
};
std::optional<Quantity> next_quantity(std::string& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::string number = text.substr(0, end);
  const auto value = number_in<double>(number);
  if (!value) return std::nullopt;
  text = trimmed(text.substr(end));
  const std::size_t unit_end = std::min(text.find(' '), text.size());
  Quantity quantity{.value = *value, .unit = text.substr(0, unit_end)};
  text = trimmed(text.substr(unit_end));
  return quantity;
}

// The next quantity in the unit that has the factor 1; the text before it is `word`.
double expected(std::string& rest, std::string_view word,
                const std::map<std::string, double>& factors, const std::string& whole) {
  const auto refuse_it = [&] {
    refuse(whole,
           "LENGTH at SPEED, or LENGTH at SPEED exposed TIME, as in '5mm at 2m/s' or '5mm at 2m/s "
           "exposed 1ms' (um, mm, cm, m; mm/s, cm/s, m/s, km/h; us, ms, s)");
  };
  if (!rest.starts_with(word)) refuse_it();
  rest.erase(0, word.size());
  const std::optional<Quantity> quantity = next_quantity(rest);
  if (!quantity || !factors.contains(quantity->unit) || !(quantity->value > 0)) refuse_it();
  return quantity->value * factors.at(quantity->unit);
}

bool is_tolerance(const std::string& text) {
  return text.find_first_of("<>") == std::string::npos && text.find(" at ") != std::string::npos;
}

}  // namespace

double Requirement::size_of(double value) const {
  return metric->better == Better::kNearestZero ? std::abs(value) : value;
}

bool Requirement::is_met_by(double value) const {
  const double size = size_of(value);
  if (std::isnan(size)) return false;
  if (size == limit) return takes_limit;
  return is_least ? size > limit : size < limit;
}

double Requirement::bad_quantile(const std::vector<double>& values, double p) const {
  std::vector<double> sizes(values.size());
  std::ranges::transform(values, sizes.begin(), [this](double value) { return size_of(value); });
  return quantile(std::move(sizes), is_least ? 1 - p : p);
}

double Requirement::margin_of(double value) const {
  const double size = size_of(value);
  if (!is_least) return limit / size;
  return metric->is_share() ? (1 - limit) / (1 - size) : size / limit;
}

Requirement parse_requirement(const std::string& text) {
  const std::string whole = trimmed(text);
  const std::size_t sign = whole.find_first_of("<>");
  if (sign == std::string::npos) {
    refuse(text,
           "METRIC<VALUE or METRIC>VALUE with a unit, as in 'amd<0.1ms', or the task's tolerance "
           "with its speed, as in '5mm at 2m/s'");
  }
  Requirement requirement{.metric = &metric_named(trimmed(whole.substr(0, sign))),
                          .is_least = whole[sign] == '>',
                          .text = whole};
  std::string bound = whole.substr(sign + 1);
  if (bound.starts_with('=')) {
    requirement.takes_limit = true;
    bound.erase(0, 1);
  }
  bound = trimmed(bound);
  const std::size_t end = bound.find_first_not_of("0123456789.");
  const std::string number = bound.substr(0, end);
  const std::string unit = end == std::string::npos ? "" : trimmed(bound.substr(end));
  constexpr std::size_t kLongest = 30;
  if (number.empty() || number.size() > kLongest || std::ranges::count(number, '.') > 1 ||
      number == ".") {
    refuse(text, "a number from 0 after the sign, as in 'amd<0.1ms'");
  }
  requirement.limit = std::stod(number) * factor_of(*requirement.metric, unit, text);
  check_bound(requirement);
  return requirement;
}

std::vector<Requirement> parse_tolerance(const std::string& text) {
  const std::map<std::string, double> lengths = {{"um", 1e-3}, {"mm", 1}, {"cm", 10}, {"m", 1e3}};
  const std::map<std::string, double> speeds = {
      {"mm/s", 1e-3}, {"cm/s", 1e-2}, {"m/s", 1}, {"km/h", 1 / 3.6}};  // mm in a millisecond
  const std::map<std::string, double> times = {{"us", 1e-3}, {"ms", 1}, {"s", 1e3}};
  std::string rest = trimmed(text);
  const double length_mm = expected(rest, "", lengths, text);
  const double speed = expected(rest, "at ", speeds, text);
  std::optional<double> exposure_ms;
  if (!rest.empty()) exposure_ms = expected(rest, "exposed ", times, text);
  if (!rest.empty()) refuse(text, "nothing behind the tolerance");
  const double whole_ms = length_mm / speed;
  const double limit_ms = whole_ms - exposure_ms.value_or(0);
  if (!(limit_ms > 0)) {
    refuse(text, fmt::format("an exposure below {:.3g} ms, in which what moves passes the whole "
                             "tolerance",
                             whole_ms));
  }
  Requirement spread = parse_requirement(fmt::format("exposure_spread<={:.4g}ms", limit_ms));
  spread.limit = limit_ms;
  Requirement pure = parse_requirement(fmt::format("precision>={:g}%", 100 * kWantedPureSets));
  for (Requirement* each : {&spread, &pure}) {
    each->tolerance = trimmed(text);
    each->exposure_ms = exposure_ms;
  }
  return {spread, pure};
}

std::vector<Requirement> parse_requirements(const std::vector<std::string>& texts) {
  std::vector<Requirement> requirements;
  for (const std::string& text : texts) {
    if (is_tolerance(text)) {
      std::ranges::move(parse_tolerance(text), std::back_inserter(requirements));
    } else {
      requirements.push_back(parse_requirement(text));
    }
  }
  if (requirements.empty()) refuse("", "at least one, as in 'amd<0.1ms'");
  return requirements;
}

std::optional<double> exposure_ms_of(const std::vector<Requirement>& requirements) {
  std::optional<double> exposure_ms;
  for (const Requirement& each : requirements) {
    if (exposure_ms && each.exposure_ms && *exposure_ms != *each.exposure_ms) {
      refuse(each.tolerance, "one exposure in all tolerances");
    }
    if (each.exposure_ms) exposure_ms = each.exposure_ms;
  }
  return exposure_ms;
}

}  // namespace simbench::evaluation
