#include "bags/checksum.h"

#include <array>
#include <cstddef>

namespace simbench::bags {
namespace {

constexpr std::size_t kSlices = 8;
using Table = std::array<std::array<std::uint32_t, 256>, kSlices>;

// Entry [k][b]: what byte b, with k bytes of zero behind it, adds to the sum.
constexpr Table make_table() {
  constexpr std::uint32_t kPolynomial = 0xedb88320U;
  Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? sum >> 1U ^ kPolynomial : sum >> 1U;
    table[0][byte] = sum;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = table[slice - 1][byte];
      table[slice][byte] = before >> 8U ^ table[0][before & 0xffU];
    }
  }
  return table;
}

constexpr Table kTable = make_table();

std::uint32_t u32_at(const char* bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<std::uint8_t>(bytes[i]);
  return value;
}

}  // namespace

void Checksum::add(std::string_view bytes) {
  std::uint32_t state = state_;
  while (bytes.size() >= kSlices) {
    const std::uint32_t low = u32_at(bytes.data()) ^ state;
    const std::uint32_t high = u32_at(bytes.data() + 4);
    state = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      state ^= kTable[7 - i][low >> 8 * i & 0xffU] ^ kTable[3 - i][high >> 8 * i & 0xffU];
    }
    bytes.remove_prefix(kSlices);
  }
  for (const char byte : bytes) {
    state = state >> 8U ^ kTable[0][(state ^ static_cast<std::uint8_t>(byte)) & 0xffU];
  }
  state_ = state;
}

}  // namespace simbench::bags
