// Unwraps a counter: each reading becomes the number nearest to the previous one that equals the
// reading modulo the counter's range (half-range rule).
//
// Frames may be delivered out of order, so a smaller reading is a wrap only if the decrease is more
// than half of the modulus; a reading from before the wrap that comes after it goes back.
// Consecutive readings must lie less than half a modulus apart (for a D455's register 35 min); one
// that is exactly half apart counts as earlier. The first reading stays as it is, so results may
// become negative if it was delivered ahead of earlier frames near zero.
//
// Source: docs/reference/device_time.md section 1 (Unwrapping), docs/reference/d455.md section 1
// (Wrap).
//
//   DeviceStampUnwrapper unwrapper;   // one per camera
//   DeviceTime sensor = unwrapper.unwrap(record.sensor);
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/ports/time.h"

namespace simbench {

// For a counter with the values 0 .. kModulus - 1.
template <std::int64_t kModulus>
class CounterUnwrapper {
  static_assert(kModulus > 1);

 public:
  // 0 <= reading < kModulus.
  std::int64_t unwrap(std::int64_t reading) {
    if (!previous_) return *(previous_ = reading);
    if constexpr (kModulus == std::int64_t{1} << 32) {  // the arithmetic of 32 bits
      return *previous_ += static_cast<std::int32_t>(static_cast<std::uint32_t>(reading) -
                                                     static_cast<std::uint32_t>(*previous_));
    }
    std::int64_t step = (reading - *previous_) % kModulus;
    if (step >= kModulus - kModulus / 2) step -= kModulus;
    if (step < -(kModulus / 2)) step += kModulus;
    return *previous_ += step;
  }

 private:
  std::optional<std::int64_t> previous_;
};

// For a camera's 32-bit microsecond register.
class DeviceStampUnwrapper {
 public:
  DeviceTime unwrap(DeviceStamp stamp) {
    return DeviceTime(Microseconds(counter_.unwrap(stamp.us)));
  }

 private:
  CounterUnwrapper<std::int64_t{1} << 32> counter_;
};

}  // namespace simbench
