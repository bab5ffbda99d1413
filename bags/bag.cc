#include "bags/bag.h"

#include <array>
#include <filesystem>
#include <memory>
#include <string_view>

#include "recording/byte_stream.h"
#include "recording/file_kind.h"

namespace simbench::bags {
namespace {

constexpr std::size_t kFirstBytes = 16;

std::string first_bytes(ByteStream& stream) {
  std::string bytes(kFirstBytes, '\0');
  bytes.resize(stream.read_up_to(bytes.data(), bytes.size()));
  return bytes;
}

std::optional<BagFormat> format_of(std::string_view bytes) {
  if (bytes.starts_with(kRosbagMagic)) return BagFormat::kRosbag;
  if (bytes.starts_with(kMcapMagic)) return BagFormat::kMcap;
  if (bytes.starts_with(kSqliteMagic)) return BagFormat::kSqlite;
  return std::nullopt;
}

}  // namespace

std::string_view to_text(BagFormat format) {
  constexpr std::array<std::string_view, 3> kNames = {"rosbag 2.0", "MCAP", "rosbag2 (SQLite)"};
  return kNames.at(static_cast<std::size_t>(format));
}

std::optional<BagFormat> bag_format(const std::string& path) {
  FileBytes file(path);
  return format_of(first_bytes(file));
}

bool is_compressed_whole(const std::string& path) {
  constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";
  FileBytes file(path);
  if (!first_bytes(file).starts_with(kZstdMagic)) return false;
  file.seek(0);
  try {
    const std::unique_ptr<ByteStream> plain = inflated(Compression::kZstd, file);
    return format_of(first_bytes(*plain)).has_value();
  } catch (const InflateError&) {
    return false;
  }
}

std::string unpacking_text(const std::string& path) {
  const std::filesystem::path file(path);
  const bool has_suffix = file.extension() == ".zstd" || file.extension() == ".zst";
  const std::string to = has_suffix ? (file.parent_path() / file.stem()).string() : path + ".bag";
  return "is compressed as a whole (zstd); unpack it: zstd -d " + path + " -o " + to;
}

BagFacts read_bag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  try {
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
