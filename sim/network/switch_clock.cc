#include "sim/network/switch_clock.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "sim/engine/random.h"
#include "sim/network/link_latency.h"

namespace simbench::sim {
namespace {

using scenarios::SwitchClockKind;

constexpr ComponentKey kResidenceError("network: error of the residence time");
constexpr ComponentKey kBoundaryError("network: error of the boundary clock");
constexpr std::int64_t kBoundaryGridNs = 30'000'000'000;

constexpr std::byte kLowNibble{0x0F};
constexpr std::byte kLastEventType{3};
constexpr std::byte kVersion{2};
constexpr std::size_t kEventMessageBytes = 44;
constexpr std::size_t kCorrectionBegin = 8;
constexpr std::size_t kCorrectionEnd = 16;
constexpr double kUnitsPerNs = 65536;

}  // namespace

SwitchClock::SwitchClock(const scenarios::Network& network, std::uint64_t run_seed)
    : run_seed_(run_seed),
      kind_(network.switch_clock),
      error_sigma_ns_(network.switch_clock_error_ns) {}

bool SwitchClock::corrects(const Bytes& message) const {
  return kind_ != SwitchClockKind::kNone && message.size() >= kEventMessageBytes &&
         (message[0] & kLowNibble) <= kLastEventType && (message[1] & kLowNibble) == kVersion;
}

void SwitchClock::correct(Bytes& message, const Passage& passage, Nanoseconds residence,
                          TrueTime at) const {
  RandomStream draw(run_seed_, kResidenceError, direction_of(passage.from, passage.to),
                    2 * passage.id + passage.copy);
  double correction_ns = static_cast<double>(residence.count()) + draw.normal(error_sigma_ns_);
  if (kind_ == SwitchClockKind::kBoundary) {
    if (passage.from == 0) correction_ns += boundary_error_ns(at);
    if (passage.to == 0) correction_ns -= boundary_error_ns(at);
  }
  std::uint64_t field = 0;
  for (std::size_t i = kCorrectionBegin; i < kCorrectionEnd; ++i) {
    field = (field << 8) | std::to_integer<std::uint64_t>(message[i]);
  }
  field += static_cast<std::uint64_t>(std::llround(correction_ns * kUnitsPerNs));
  for (std::size_t i = kCorrectionEnd; i-- > kCorrectionBegin; field >>= 8) {
    message[i] = static_cast<std::byte>(field & 0xFF);
  }
}

double SwitchClock::boundary_error_ns(TrueTime at) const {
  const std::int64_t since_zero_ns = at.time_since_epoch().count();
  const std::int64_t index = floor_div(since_zero_ns, kBoundaryGridNs);
  const double part = static_cast<double>(since_zero_ns - index * kBoundaryGridNs) /
                      static_cast<double>(kBoundaryGridNs);
  const auto value_ns = [&](std::int64_t i) {
    return RandomStream(run_seed_, kBoundaryError, static_cast<std::uint64_t>(i))
        .normal(error_sigma_ns_);
  };
  // Weights whose squares add up to 1 keep the variance the same everywhere.
  const double angle = part * std::numbers::pi / 2;
  return std::cos(angle) * value_ns(index) + std::sin(angle) * value_ns(index + 1);
}

}  // namespace simbench::sim
