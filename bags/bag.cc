#include "bags/bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "bags/read_budget.h"
#include "recording/append_file.h"
#include "recording/byte_stream.h"
#include "recording/file_kind.h"
#include "recording/recording_folder.h"
#include "recording/temporary_folder.h"

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

namespace {

// Passes on as many messages as a file may have; the reader knows the size of its file unpacked
// alone.
class BoundedSink final : public BagSink {
 public:
  BoundedSink(BagSink& sink, std::uint64_t file_bytes) : sink_(sink), budget_(file_bytes) {}
  std::size_t on_topic(std::uint32_t number, const BagTopic& topic) override {
    return sink_.on_topic(number, topic);
  }
  void on_message(const BagMessage& message) override {
    if (spent_.empty()) {
      try {
        budget_.take_message();
      } catch (const BudgetSpent& spent) {
        spent_ = spent.what();
      }
    }
    if (spent_.empty()) sink_.on_message(message);
  }
  // What was left out; empty: nothing.
  const std::string& spent() const { return spent_; }

 private:
  BagSink& sink_;
  ReadBudget budget_;
  std::string spent_;
};

// The plain bytes of a file that is compressed as a whole, as a file of their own. Unpacking is the
// first half of the progress, reading the second.
class UnpackedBag {
 public:
  UnpackedBag(const std::string& path, const ReadProgress& progress)
      : of_(path), path_(folder_.file("bag")), progress_(progress) {
    FileBytes compressed(path);
    compressed_size_ = compressed.size();
    try {
      copy(*inflated(Compression::kZstd, compressed), compressed);
    } catch (const RecordingFolderError& error) {
      throw BagError(path + ": cannot be unpacked: " + error.what() +
                     "; TMPDIR names another place for temporary files");
    }
  }

  BagFacts read(BagSink& sink) {
    BagFacts facts;
    BoundedSink bounded(sink, compressed_size_);
    try {
      facts = read_bag(path_, bounded, [&](std::uint64_t done, std::uint64_t) {
        // In bytes of the file that the user has.
        report((compressed_size_ + scaled(done)) / 2);
      });
    } catch (const BagError& error) {
      throw BagError(renamed(error.what()) + (lost_.empty() ? "" : "; " + lost_));
    }
    for (std::string& note : facts.notes) note = renamed(note);
    facts.description += ", compressed as a whole (zstd)";
    if (!bounded.spent().empty()) facts.notes.push_back(of_ + ": " + bounded.spent());
    if (!lost_.empty()) {
      facts.notes.push_back(lost_);
      facts.indexed = false;
    }
    return facts;
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{256} << 10;

  // As far as the bytes are good, and as many as there may be.
  void copy(ByteStream& plain, const FileBytes& compressed) {
    AppendFile file(path_);
    try {
      while (copy_block(plain, file)) {
        report(compressed.position() / 2);
        if (plain_size_ <= most_inflated(compressed.position())) continue;
        lost_ = fmt::format(
            "{}: found more than {} times its bytes when inflated; the rest is left out", of_,
            kMostInflation);
        break;
      }
    } catch (const InflateError& error) {
      lost_ = fmt::format("{}: {}; the rest is lost", of_, error.what());
    }
    file.close();
  }
  // False at the end.
  bool copy_block(ByteStream& plain, AppendFile& file) {
    std::string& block = file.buffer();
    block.resize(kBlock);
    std::size_t size = 0;
    try {
      size = plain.read(block.data(), kBlock);
    } catch (...) {
      block.clear();
      throw;
    }
    block.resize(size);
    file.flush();
    plain_size_ += size;
    return size > 0;
  }
  void report(std::uint64_t done) const {
    if (progress_) progress_(done, compressed_size_);
  }
  std::uint64_t scaled(std::uint64_t done) const {
    const double share =
        static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(plain_size_, 1));
    return static_cast<std::uint64_t>(share * static_cast<double>(compressed_size_));
  }
  // Messages name the file that the user has.
  std::string renamed(std::string text) const {
    if (text.starts_with(path_)) text.replace(0, path_.size(), of_ + ", unpacked");
    return text;
  }

  std::string of_;
  TemporaryFolder folder_;
  std::string path_;
  const ReadProgress& progress_;
  std::uint64_t compressed_size_ = 0;
  std::uint64_t plain_size_ = 0;
  std::string lost_;
};

}  // namespace

BagFacts read_bag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  try {
    const std::optional<BagFormat> format = bag_format(path);
    if (!format && is_compressed_whole(path)) return UnpackedBag(path, progress).read(sink);
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
