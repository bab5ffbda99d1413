// Whole numbers as they go over the wire: least significant byte first.
#ifndef SIMBENCH_HARDWARE_NET_WIRE_NUMBERS_H_
#define SIMBENCH_HARDWARE_NET_WIRE_NUMBERS_H_

#include <cstddef>
#include <cstdint>
#include <span>

namespace simbench::hardware {

// Fills all of `to`; what of the number does not fit is left out.
inline void put_number(std::span<std::byte> to, std::uint64_t number) {
  for (std::byte& byte : to) {
    byte = static_cast<std::byte>(number & 0xff);
    number >>= 8;
  }
}

// From at most 8 bytes.
inline std::uint64_t number_in(std::span<const std::byte> from) {
  std::uint64_t number = 0;
  for (std::size_t i = from.size(); i-- > 0;) {
    number = number << 8 | std::to_integer<std::uint64_t>(from[i]);
  }
  return number;
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_WIRE_NUMBERS_H_
