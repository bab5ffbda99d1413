// CRC-32 as MCAP has it (zlib's), in parts.
//
//   Checksum sum;
//   sum.add({buffer, size});
//   if (sum.value() != stated) ...
//
// Complexity: linear, about a nanosecond a byte. Source: mcap.dev/spec; RFC 1952, section 8.
#pragma once

#include <cstdint>
#include <string_view>

namespace simbench::bags {

class Checksum {
 public:
  void add(std::string_view bytes);
  std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 0;
};

}  // namespace simbench::bags
