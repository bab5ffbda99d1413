// A count in a message: "1 run", "3 runs"; "once", "3 times".
//
//   const std::string text = counted(3, "run") + ", " + times(3);
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace simbench {

inline std::string counted(std::uint64_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

inline std::string times(std::uint64_t count) {
  return count == 1 ? "once" : std::to_string(count).append(" times");
}

}  // namespace simbench
