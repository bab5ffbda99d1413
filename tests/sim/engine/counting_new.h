// Counts the allocations of the test program: operator new, and std::aligned_alloc, from which Asio
// takes the frames of coroutines.
//
//   const std::uint64_t before = allocations();
//   ...
//   EXPECT_EQ(allocations() - before, 0);
#pragma once

#include <cstdint>

namespace simbench::sim {

std::uint64_t allocations();

}  // namespace simbench::sim
