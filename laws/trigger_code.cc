#include "laws/trigger_code.h"

#include <algorithm>
#include <array>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// The taps of a shift register of maximal length, as a mask of its stages 1 to n, n being bit
// n - 1; for orders from TriggerCode::kLowestOrder on.
constexpr std::uint32_t taps(std::initializer_list<int> stages) {
  std::uint32_t mask = 0;
  for (const int stage : stages) mask |= std::uint32_t{1} << (stage - 1);
  return mask;
}
constexpr std::array<std::uint32_t, 13> kTaps = {
    taps({4, 3}),          taps({5, 3}),        taps({6, 5}),        taps({7, 6}),
    taps({8, 6, 5, 4}),    taps({9, 5}),        taps({10, 7}),       taps({11, 9}),
    taps({12, 6, 4, 1}),   taps({13, 4, 3, 1}), taps({14, 5, 3, 1}), taps({15, 14}),
    taps({16, 15, 13, 4}),
};

std::int32_t in_32_bits(Nanoseconds shift) { return static_cast<std::int32_t>(shift.count()); }

}  // namespace

std::vector<std::uint8_t> de_bruijn_sequence(int order) {
  SIMBENCH_ASSERT(order >= TriggerCode::kLowestOrder && order <= TriggerCode::kHighestOrder,
                  "the orders of a code are 4 to 16");
  const std::uint32_t mask = kTaps[static_cast<std::size_t>(order - TriggerCode::kLowestOrder)];
  const std::uint32_t all = (std::uint32_t{1} << order) - 1;
  const std::uint32_t last = std::uint32_t{1} << (order - 1);
  std::vector<std::uint8_t> symbols;
  symbols.reserve(std::size_t{all} + 1);
  std::uint32_t state = 1;
  do {
    symbols.push_back((state & last) != 0 ? 1 : 0);
    // The register's one run of order - 1 zeros becomes one longer.
    if (state == last) symbols.push_back(0);
    const auto next = static_cast<std::uint32_t>(__builtin_popcount(state & mask) & 1);
    state = ((state << 1) | next) & all;
  } while (state != 1);
  return symbols;
}

TriggerCode::TriggerCode(Nanoseconds period, std::vector<std::int32_t> shifts_ns,
                         std::vector<std::uint8_t> is_sent)
    : period_(period), shifts_ns_(std::move(shifts_ns)), is_sent_(std::move(is_sent)) {
  SIMBENCH_ASSERT(period > Nanoseconds(0), "pulses have a period");
  const auto [lowest, highest] = std::ranges::minmax(shifts_ns_);
  range_ = Nanoseconds(std::int64_t{highest} - lowest);
  shortest_ = Nanoseconds::max();
  std::int64_t sent = 0;
  std::int64_t previous = -1;
  // Once around, and on to the first pulse again.
  for (std::int64_t pulse = 0; pulse < 2 * length(); ++pulse) {
    if (!is_sent_[place(pulse)]) continue;
    if (previous >= 0) {
      const Nanoseconds interval = (pulse - previous) * period + shift(pulse) - shift(previous);
      shortest_ = std::min(shortest_, interval);
      longest_ = std::max(longest_, interval);
    }
    if (pulse < length()) {
      ++sent;
    } else {
      break;
    }
    previous = pulse;
  }
  SIMBENCH_ASSERT(sent > 0 && shortest_ > period / 2, "a code leaves its pulses apart");
  leaves_out_ = sent < length();
  sent_share_ = static_cast<double>(sent) / static_cast<double>(length());
}

TriggerCode TriggerCode::position(Nanoseconds period, int order, Nanoseconds shift) {
  std::vector<std::int32_t> shifts_ns;
  for (const std::uint8_t symbol : de_bruijn_sequence(order)) {
    shifts_ns.push_back(in_32_bits(symbol != 0 ? shift : -shift));
  }
  std::vector<std::uint8_t> sent(shifts_ns.size(), 1);
  return {period, std::move(shifts_ns), std::move(sent)};
}

TriggerCode TriggerCode::missing(Nanoseconds period, int order, std::size_t pulses) {
  SIMBENCH_ASSERT(pulses >= 2, "of one pulse a symbol, half of all would be left out");
  std::vector<std::uint8_t> sent;
  for (const std::uint8_t symbol : de_bruijn_sequence(order)) {
    sent.insert(sent.end(), pulses - 1, 1);
    sent.push_back(symbol != 0 ? 0 : 1);
  }
  std::vector<std::int32_t> shifts_ns(sent.size(), 0);
  return {period, std::move(shifts_ns), std::move(sent)};
}

TriggerCode TriggerCode::frequency(Nanoseconds period, int order, std::size_t pulses,
                                   Nanoseconds shift) {
  SIMBENCH_ASSERT(pulses >= 2 && pulses % 2 == 0, "a symbol has two halves");
  std::vector<std::int32_t> shifts_ns;
  const auto half = static_cast<std::int64_t>(pulses / 2);
  for (const std::uint8_t symbol : de_bruijn_sequence(order)) {
    for (std::int64_t pulse = 1; pulse <= 2 * half; ++pulse) {
      const std::int64_t steps = pulse <= half ? pulse : 2 * half - pulse;
      shifts_ns.push_back(in_32_bits((symbol != 0 ? steps : -steps) * shift));
    }
  }
  std::vector<std::uint8_t> sent(shifts_ns.size(), 1);
  return {period, std::move(shifts_ns), std::move(sent)};
}

}  // namespace simbench
