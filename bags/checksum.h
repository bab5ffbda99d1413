// CRC-32 as MCAP has it (polynomial 0xedb88320, reflected), eight bytes at a time.
//
//   Checksum sum;
//   sum.add({buffer, size});
//   if (sum.value() != stated) ...
//
// Complexity: linear, about a nanosecond a byte or less. Source: M. E. Kounavis and F. L. Berry, A
// Systematic Approach to Building High Performance Software-Based CRC Generators, ISCC 2005.
#pragma once

#include <cstdint>
#include <string_view>

namespace simbench::bags {

class Checksum {
 public:
  void add(std::string_view bytes);
  std::uint32_t value() const { return ~state_; }

 private:
  std::uint32_t state_ = ~std::uint32_t{0};
};

}  // namespace simbench::bags
