#include "evaluation/sweep/sweep_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/run/jobs.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/number_in.h"
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
  const std::optional<double> value = number_in<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// The decimals in a number's text: 0.25 has 2, 3e-4 has 4.
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

// start + i * step. With few decimals the sum is one of whole numbers, which is exact, and its
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
  // The first pointer tells the steps apart; what goes in lockstep with it may rest.
  if (result.pointers.size() > 1) return;
  std::set<std::string> seen;
  for (const std::string& value : result.values.back()) {
    if (!seen.insert(value).second) fail(axis, fmt::format("found the value {} twice", value));
  }
}

using scenarios::InputError;
using scenarios::Scenario;

void check_pointers(const SweepPlan& plan) {
  std::set<std::string> seen;
  for (const std::string& pointer : plan.pointers()) {
    if (!seen.insert(pointer).second) {
      throw InputError(fmt::format("--sweep {}: the pointer is swept twice", pointer));
    }
  }
}

void check_size(const SweepPlan& plan) {
  double runs = static_cast<double>(plan.pipelines.size()) * static_cast<double>(plan.seeds);
  for (const SweepAxis& axis : plan.axes) runs *= static_cast<double>(axis.steps());
  if (runs <= static_cast<double>(kMostRuns)) return;
  throw InputError(
      fmt::format("--sweep: {:.3g} runs in all, allowed: at most {}; take fewer values or seeds",
                  runs, kMostRuns));
}

// The loader's messages name --set, the option for overrides.
std::string as_sweep(std::string message) {
  if (message.starts_with("--set ")) message.replace(0, 5, "--sweep");
  return message;
}

// The pipelines of the request that its runs have at a scenario.
ClockPipelines pipelines_of(const Scenario& scenario, const SweepRequest& request,
                            const std::vector<std::string>& names) {
  if (request.kind == ResultKind::kClockRuns) {
    return clock_pipelines(scenario, {.duration_s = request.clock_period.duration_s,
                                      .from_s = request.clock_period.from_s,
                                      .pipelines = names});
  }
  ClockPipelines pipelines;
  for (const PipelineChoice& choice : choose_pipelines(scenario, names)) {
    pipelines.names.push_back(choice.pipeline.name);
  }
  return pipelines;
}

// Returns the warnings of the scenario at a point. Throws InputError if the point is invalid.
std::vector<std::string> check_point(const SweepPlan& plan, const SweepRequest& request,
                                     std::size_t point) {
  try {
    std::vector<scenarios::Override> overrides = request.overrides;
    const std::vector<scenarios::Override> swept = plan.overrides(point);
    overrides.insert(overrides.end(), swept.begin(), swept.end());
    const Scenario scenario = scenarios::load_scenario(request.scenario, overrides);
    pipelines_of(scenario, request, plan.pipelines);
    return scenarios::warnings(scenario);
  } catch (const InputError& error) {
    throw InputError(fmt::format("point {} of {} of the sweep ({}) is refused: {}", point + 1,
                                 plan.points(), plan.point_text(point), as_sweep(error.what())));
  }
}

bool sweeps_load(const SweepPlan& plan) {
  const std::vector<std::string> pointers = plan.pointers();
  return std::ranges::any_of(Scenario::kLoadMembers, [&](const char* member) {
    return std::ranges::find(pointers, member) != pointers.end();
  });
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

std::size_t SweepPlan::points() const {
  std::size_t points = 1;
  for (const SweepAxis& axis : axes) points *= axis.steps();
  return points;
}

SweepRun SweepPlan::run(std::size_t index) const {
  const std::size_t row = index / seeds;
  return {.point = row / pipelines.size(),
          .pipeline = row % pipelines.size(),
          .seed = first_seed + index % seeds};
}

std::vector<std::size_t> SweepPlan::steps(std::size_t point) const {
  std::vector<std::size_t> steps(axes.size());
  for (std::size_t axis = axes.size(); axis-- > 0;) {
    steps[axis] = point % axes[axis].steps();
    point /= axes[axis].steps();
  }
  return steps;
}

std::vector<std::string> SweepPlan::pointers() const {
  std::vector<std::string> pointers;
  for (const SweepAxis& axis : axes) {
    pointers.insert(pointers.end(), axis.pointers.begin(), axis.pointers.end());
  }
  return pointers;
}

std::vector<std::string> SweepPlan::values(std::size_t point) const {
  const std::vector<std::size_t> at = steps(point);
  std::vector<std::string> values;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const auto& steps_of_pointer : axes[axis].values) {
      values.push_back(steps_of_pointer[at[axis]]);
    }
  }
  return values;
}

std::vector<scenarios::Override> SweepPlan::overrides(std::size_t point) const {
  const std::vector<std::string> names = pointers();
  const std::vector<std::string> at = values(point);
  std::vector<scenarios::Override> overrides;
  for (std::size_t i = 0; i < names.size(); ++i) overrides.push_back({names[i], at[i]});
  return overrides;
}

std::string SweepPlan::point_text(std::size_t point) const {
  std::vector<std::string> texts;
  for (const scenarios::Override& value : overrides(point)) {
    texts.push_back(fmt::format("{}={}", value.pointer, value.value));
  }
  return texts.empty() ? "as it is" : fmt::format("{}", fmt::join(texts, ", "));
}

SweepPlan make_plan(const SweepRequest& request) {
  SweepPlan plan;
  plan.first_seed = request.first_seed;
  plan.seeds = request.seeds;
  plan.kind = request.kind;
  plan.clock_period = request.clock_period;
  for (const std::string& axis : request.axes) plan.axes.push_back(parse_axis(axis));
  check_pointers(plan);
  const Scenario scenario = scenarios::load_scenario(request.scenario, request.overrides);
  plan.scenario = scenario.name;
  plan.derivation = scenario.derivation;
  plan.draws_load = scenario.draws_load() || sweeps_load(plan);
  plan.ranked_by = request.ranked_by.value_or(ranked_by(scenario.evaluation.table));
  plan.scenario_json = scenario.resolved_json();
  ClockPipelines chosen = pipelines_of(scenario, request, request.pipelines);
  plan.pipelines = std::move(chosen.names);
  plan.left_out = std::move(chosen.left_out);
  check_size(plan);
  return plan;
}

std::vector<std::string> check_points(const SweepPlan& plan, const SweepRequest& request,
                                      unsigned threads) {
  std::mutex mutex;
  std::set<std::string> texts;
  run_jobs(plan.points(), {.threads = threads}, [&](std::size_t point) {
    const std::vector<std::string> warnings = check_point(plan, request, point);
    const std::lock_guard lock(mutex);
    texts.insert(warnings.begin(), warnings.end());
  });
  return {texts.begin(), texts.end()};
}

}  // namespace simbench::evaluation
