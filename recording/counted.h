// A count and its thing in a message: "1 run", "3 runs".
//
//   const std::string text = counted(3, "run");
#ifndef SIMBENCH_RECORDING_COUNTED_H_
#define SIMBENCH_RECORDING_COUNTED_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace simbench {

inline std::string counted(std::uint64_t count, std::string_view thing) {
  return std::to_string(count).append(" ").append(thing).append(count == 1 ? "" : "s");
}

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_COUNTED_H_
