#include "reports/trigger_code/code_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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

}  // namespace

std::string code_header(const TriggerCode& code, const std::string& scenario, double timer_hz) {
  const std::vector<std::int64_t> ticks = intervals_in_ticks(code, timer_hz);
  const auto [shortest, longest] = std::ranges::minmax(ticks);
  constexpr std::int64_t kMost = (std::int64_t{1} << 32) - 1;
  if (shortest < 1 || longest > kMost) {
    throw scenarios::InputError(
        fmt::format("--timer-hz: found {:g}, with which intervals are {} to {} ticks, allowed 1 to "
                    "{}",
                    timer_hz, shortest, longest, kMost));
  }
  const int bits = longest < (1 << 16) ? 16 : 32;
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
      scenario, version(), timer_hz, to_seconds(code.span()),
      static_cast<double>(ticks.size()) / to_seconds(code.span()), ticks.size(), bits);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const bool ends_line = i % kNumbersInLine == kNumbersInLine - 1 || i + 1 == ticks.size();
    text += fmt::format("{}{},{}", i % kNumbersInLine == 0 ? "    " : "", ticks[i],
                        ends_line ? "\n" : " ");
  }
  return text + "};\n\n#endif\n";
}

}  // namespace simbench::reports
