// The reader of rosbag2's SQLite. That opens its file by name, so it gets one in a folder.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/bag_reader.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz_sqlite_bag_XXXXXX").string();
    if (mkstemp(name.data()) < 0) std::abort();
    return name;
  }();
  std::filesystem::remove(path);  // replacing a file is slow where that flushes it
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  simbench::bags::check_reader(simbench::bags::read_sqlite_bag, path);
  return 0;
}
