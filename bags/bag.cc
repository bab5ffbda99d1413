#include "bags/bag.h"

#include <array>
#include <filesystem>

#include "bags/byte_stream.h"

namespace simbench::bags {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kRosbagMagic = "#ROSBAG V2.0"sv;
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n"sv;
constexpr std::string_view kSqliteMagic = "SQLite format 3\0"sv;
constexpr std::string_view kWholeZstdMagic = "\x28\xb5\x2f\xfd"sv;

std::string first_bytes(const std::string& path) {
  std::string bytes(16, '\0');
  bytes.resize(FileBytes(path).read_up_to(bytes.data(), bytes.size()));
  return bytes;
}

}  // namespace

std::string_view to_text(BagFormat format) {
  constexpr std::array<std::string_view, 3> kNames = {"rosbag 2.0", "MCAP", "rosbag2 (SQLite)"};
  return kNames.at(static_cast<std::size_t>(format));
}

std::optional<BagFormat> bag_format(const std::string& path) {
  const std::string bytes = first_bytes(path);
  if (bytes.starts_with(kRosbagMagic)) return BagFormat::kRosbag;
  if (bytes.starts_with(kMcapMagic)) return BagFormat::kMcap;
  if (bytes.starts_with(kSqliteMagic)) return BagFormat::kSqlite;
  return std::nullopt;
}

bool is_compressed_whole(const std::string& path) {
  return first_bytes(path).starts_with(kWholeZstdMagic);
}

std::string unpacking_text(const std::string& path) {
  const std::filesystem::path file(path);
  const bool has_suffix = file.extension() == ".zstd" || file.extension() == ".zst";
  const std::string to = has_suffix ? (file.parent_path() / file.stem()).string() : path + ".bag";
  return "is compressed as a whole (zstd); unpack it: zstd -d " + path + " -o " + to;
}

BagFacts read_bag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  try {
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
      throw BagError(path +
                     ": found a pipe, a device or a folder, allowed: a file, since a bag is read "
                     "from several places");
    }
    const std::optional<BagFormat> format = bag_format(path);
    if (!format && is_compressed_whole(path)) throw BagError(path + ": " + unpacking_text(path));
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
