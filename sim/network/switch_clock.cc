#include "sim/network/switch_clock.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/engine/random.h"
#include "sim/network/link_latency.h"

namespace simbench::sim {
namespace {

using scenarios::SwitchClockKind;

constexpr ComponentKey kResidenceError("network: error of the residence time");
constexpr ComponentKey kBoundaryError("network: error of the boundary clock");
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kSecondsBeforeZero = 3600;
constexpr double kProportional = 0.7;
constexpr double kIntegral = 0.3;

constexpr std::byte kLowNibble{0x0F};
constexpr std::byte kLastEventType{3};
constexpr std::byte kVersion{2};
constexpr std::size_t kEventMessageBytes = 44;
constexpr std::size_t kLengthBegin = 2;
constexpr std::size_t kMostTrailer = 80;
constexpr std::size_t kCorrectionBegin = 8;
constexpr std::size_t kCorrectionEnd = 16;
constexpr double kUnitsPerNs = 65536;

std::size_t stated_length(const Bytes& message) {
  return std::to_integer<std::size_t>(message[kLengthBegin]) << 8 |
         std::to_integer<std::size_t>(message[kLengthBegin + 1]);
}

}  // namespace

SwitchClock::SwitchClock(const scenarios::Network& network, std::uint64_t run_seed)
    : run_seed_(run_seed),
      kind_(network.switch_clock),
      error_sigma_ns_(network.switch_clock_error_ns),
      switch_of_host_(network.switch_of_host) {
  if (kind_ != SwitchClockKind::kBoundary) return;
  const std::int64_t last =
      switch_of_host_.empty() ? 0 : *std::ranges::max_element(switch_of_host_);
  boundary_clocks_.reserve(static_cast<std::size_t>(last) + 1);
  for (std::int64_t number = 0; number <= last; ++number) {
    boundary_clocks_.emplace_back(network, run_seed, static_cast<std::uint64_t>(number));
  }
}

bool SwitchClock::corrects(const Bytes& message) const {
  if (kind_ == SwitchClockKind::kNone || message.size() < kEventMessageBytes) return false;
  const std::size_t length = stated_length(message);
  return (message[0] & kLowNibble) <= kLastEventType && (message[1] & kLowNibble) == kVersion &&
         length >= kEventMessageBytes && length <= message.size() &&
         message.size() - length <= kMostTrailer;
}

void SwitchClock::correct(Bytes& message, const Passage& passage, Nanoseconds residence,
                          TrueTime at) const {
  RandomStream draw(run_seed_, kResidenceError, direction_of(passage.from, passage.to),
                    2 * passage.id + passage.copy);
  double correction_ns = static_cast<double>(residence.count()) + draw.normal(error_sigma_ns_);
  if (kind_ == SwitchClockKind::kBoundary) {
    if (passage.from == 0) correction_ns += boundary_error_ns(passage.to, at);
    if (passage.to == 0) correction_ns -= boundary_error_ns(passage.from, at);
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

double SwitchClock::boundary_error_ns(PeerId host, TrueTime at) const {
  const auto [first, last] = std::minmax({switch_of(0), switch_of(host)});
  double error_ns = 0;
  for (std::int64_t number = first; number <= last; ++number) {
    error_ns += boundary_clocks_[static_cast<std::size_t>(number)].error_ns(at);
  }
  return error_ns;
}

BoundaryClock::BoundaryClock(const scenarios::Network& network, std::uint64_t run_seed,
                             std::uint64_t number)
    : run_seed_(run_seed),
      number_(number),
      noise_ns_(network.switch_clock_error_ns),
      wander_ppb_(network.switch_clock_wander_ppb_per_sqrt_s),
      walk_(kSecondNs, Servo{}) {}

double BoundaryClock::error_ns(TrueTime at) const {
  return walk_.phase_ns(
      at.time_since_epoch().count() + kSecondsBeforeZero * kSecondNs,
      [this](Servo& servo, std::int64_t second, double) { return step(servo, second); });
}

double BoundaryClock::step(Servo& servo, std::int64_t second) const {
  RandomStream draw(run_seed_, kBoundaryError, number_, static_cast<std::uint64_t>(second));
  const double measured_ns = servo.error_ns + draw.normal(noise_ns_);
  servo.integral_ppb += kIntegral * measured_ns;
  const double growth_ns = servo.frequency_ppb - kProportional * measured_ns - servo.integral_ppb;
  servo.frequency_ppb += draw.normal(wander_ppb_);
  servo.error_ns += growth_ns;
  return growth_ns;
}

}  // namespace simbench::sim
