// What a simulated host is: one processor, on which the programs take no time, so much memory, and
// a disk that never fills.
//
//   print(host_uptime());
#pragma once

#include <cstdint>

namespace simbench::shim {

inline constexpr std::uint64_t kPageSize = 4096;
inline constexpr std::uint64_t kMemory = std::uint64_t{4} << 30U;  // bytes
inline constexpr std::uint64_t kFreeMemory = kMemory / 2;
inline constexpr std::uint64_t kDiskBlocks = (std::uint64_t{64} << 30U) / kPageSize;

// By its oscillator, ns.
std::int64_t host_uptime();

}  // namespace simbench::shim
