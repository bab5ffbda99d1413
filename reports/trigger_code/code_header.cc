#include "reports/trigger_code/code_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "algorithms/coded_trigger/code_search.h"
#include "recording/version.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

constexpr std::size_t kNumbersInLine = 12;

std::vector<std::int64_t> intervals_in_ticks(const TriggerCode& code, double timer_hz) {
  std::vector<std::int64_t> ticks;
  std::int64_t before = 0;
  bool is_first = true;
  // Once around, and to the first pulse again.
  for (std::int64_t pulse = 0;; ++pulse) {
    if (!code.is_sent(pulse)) continue;
    const Nanoseconds at = pulse * code.period() + code.shift(pulse);
    const auto tick = static_cast<std::int64_t>(std::llround(to_ns(at) * 1e-9 * timer_hz));
    if (!is_first) ticks.push_back(tick - before);
    is_first = false;
    before = tick;
    if (pulse >= code.length()) return ticks;
  }
}

// The search takes noise of a sixth of a step. A pulse that is rounded is off by half a tick at
// most, with half of that as its standard deviation or a little more.
void check_steps(const TriggerCode& code, double timer_hz) {
  constexpr double kHalfTicksInStep = 12;
  const double period_us = to_ns(code.period()) * 1e-3;
  const double step_us = code.leaves_out() ? period_us : smallest_step_us(code);
  const double least_hz = kHalfTicksInStep / 2 * 1e6 / step_us;
  if (timer_hz >= least_hz) return;
  throw scenarios::InputError(
      fmt::format("--timer-hz: found {:g}, which rounds pulses to {:.4g} us, allowed at least "
                  "{:.0f}: the code moves them by {:.4g} us",
                  timer_hz, 1e6 / timer_hz, std::ceil(least_hz), step_us));
}

void check_size(const std::vector<std::int64_t>& ticks, double timer_hz) {
  const auto [shortest, longest] = std::ranges::minmax(ticks);
  constexpr std::int64_t kMost = (std::int64_t{1} << 32) - 1;
  if (shortest >= 1 && longest <= kMost) return;
  throw scenarios::InputError(
      fmt::format("--timer-hz: found {:g}, with which intervals are {} to {} ticks, allowed 1 to "
                  "{}",
                  timer_hz, shortest, longest, kMost));
}

// From a pulse that a camera answers to the next one.
std::pair<double, double> distances_us(const std::vector<std::int64_t>& ticks, std::size_t pulses,
                                       double timer_hz) {
  std::int64_t shortest = std::numeric_limits<std::int64_t>::max(), longest = 0;
  for (std::size_t first = 0; first < ticks.size(); ++first) {
    std::int64_t distance = 0;
    for (std::size_t i = 0; i < pulses; ++i) distance += ticks[(first + i) % ticks.size()];
    shortest = std::min(shortest, distance);
    longest = std::max(longest, distance);
  }
  const double tick_us = 1e6 / timer_hz;
  return {static_cast<double>(shortest) * tick_us, static_cast<double>(longest) * tick_us};
}

// What the scenario's cameras take, they must take of the rounded intervals too.
void check_window(const std::vector<std::int64_t>& ticks, const CodeMode& mode, double timer_hz) {
  const auto [shortest_us, longest_us] =
      distances_us(ticks, static_cast<std::size_t>(mode.limits.pulses_per_frame), timer_hz);
  const double least_us = to_ns(mode.limits.shortest) * 1e-3;
  const double most_us = to_ns(mode.limits.longest) * 1e-3;
  if (shortest_us >= least_us && longest_us <= most_us) return;
  throw scenarios::InputError(fmt::format(
      "--timer-hz: found {:g}, with which the pulses that a camera answers are {:.6g} to {:.6g} us "
      "apart, allowed {:.6g} to {:.6g} us for the {} stream in sync mode \"{}\": a faster timer, "
      "or a smaller /trigger/code/shift_us",
      timer_hz, shortest_us, longest_us, least_us, most_us, mode.stream, mode.mode));
}

std::vector<std::int64_t> checked_ticks(const TriggerCodeResult& result, double timer_hz) {
  check_steps(result.code, timer_hz);
  std::vector<std::int64_t> ticks = intervals_in_ticks(result.code, timer_hz);
  check_size(ticks, timer_hz);
  for (const CodeMode& mode : result.modes) {
    if (mode.is_own) check_window(ticks, mode, timer_hz);
  }
  return ticks;
}

}  // namespace

std::string code_header(const TriggerCodeResult& result, double timer_hz) {
  const std::vector<std::int64_t> ticks = checked_ticks(result, timer_hz);
  const double span_s = to_seconds(result.code.span());
  const int bits = std::ranges::max(ticks) < (1 << 16) ? 16 : 32;
  std::string text = fmt::format(
      "/* The intervals of the coded trigger of {0}, made by simbench {1}.\n"
      " * Pulse i + 1 comes code_interval_ticks[i] ticks of {2:.0f} Hz after pulse i; behind the\n"
      " * last interval the first one comes again. {3:.6f} s of the code, {4:.6f} pulses a "
      "second.\n"
      " */\n"
      "#ifndef SIMBENCH_CODE_INTERVALS_H\n"
      "#define SIMBENCH_CODE_INTERVALS_H\n\n"
      "#include <stdint.h>\n\n"
      "#define CODE_TIMER_HZ {2:.0f}UL\n"
      "#define CODE_INTERVALS {5}UL\n\n"
      "static const uint{6}_t code_interval_ticks[CODE_INTERVALS] = {{\n",
      scenarios::named(result.scenario, result.derivation), version(), timer_hz, span_s,
      static_cast<double>(ticks.size()) / span_s, ticks.size(), bits);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const bool ends_line = i % kNumbersInLine == kNumbersInLine - 1 || i + 1 == ticks.size();
    text += fmt::format("{}{},{}", i % kNumbersInLine == 0 ? "    " : "", ticks[i],
                        ends_line ? "\n" : " ");
  }
  return text + "};\n\n#endif\n";
}

}  // namespace simbench::reports
