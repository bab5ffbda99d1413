#include "bags/bag.h"

#include <array>

#include "recording/byte_stream.h"
#include "recording/file_kind.h"

namespace simbench::bags {

std::string_view to_text(BagFormat format) {
  constexpr std::array<std::string_view, 3> kNames = {"rosbag 2.0", "MCAP", "rosbag2 (SQLite)"};
  return kNames.at(static_cast<std::size_t>(format));
}

std::optional<BagFormat> bag_format(const std::string& path) {
  std::array<char, 16> first{};
  const std::string_view bytes(first.data(),
                               FileBytes(path).read_up_to(first.data(), first.size()));
  if (bytes.starts_with(kRosbagMagic)) return BagFormat::kRosbag;
  if (bytes.starts_with(kMcapMagic)) return BagFormat::kMcap;
  if (bytes.starts_with(kSqliteMagic)) return BagFormat::kSqlite;
  return std::nullopt;
}

BagFacts read_bag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  try {
    const std::optional<BagFormat> format = bag_format(path);
    if (!format) {
      throw BagError(path +
                     ": found no bag, allowed: rosbag 2.0 (also of the RealSense SDK), MCAP, or "
                     "SQLite of rosbag2");
    }
    switch (*format) {
      case BagFormat::kRosbag:
        return read_rosbag(path, sink, progress);
      case BagFormat::kMcap:
        return read_mcap(path, sink, progress);
      case BagFormat::kSqlite:
        return read_sqlite_bag(path, sink, progress);
    }
  } catch (const FileError& error) {
    throw BagError(path + ": cannot be read: " + error.what());
  }
  return {};
}

}  // namespace simbench::bags
