// Asks the cache for what is read soon. Thousands of clocks lie in no cache, and a rig's frames
// come from them in no order: a loop over frames that asks for the clock of a later one does not
// wait for each. A hint: it changes no result, and the address need not be valid.
//
//   prefetch(&clock, 128);
#pragma once

#include <cstddef>

namespace simbench::clocks {

inline void prefetch(const void* address, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) {
    __builtin_prefetch(static_cast<const char*>(address) + at);
  }
}

}  // namespace simbench::clocks
