// The reader of rosbag 2.0.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/bags/memory_file.h"
#include "tests/fuzz/bag_reader.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const simbench::bags::MemoryFile file(
      std::string_view(reinterpret_cast<const char*>(data), size));
  simbench::bags::check_reader(simbench::bags::read_rosbag, file.path());
  return 0;
}
