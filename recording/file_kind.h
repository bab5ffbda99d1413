// What a file is by its first bytes, not by its name: for messages about files that are not what
// was asked for, and to keep what no run can make again.
//
//   if (const auto kind = file_kind("#ROSBAG V2.0\n")) print(kind->what);   // "a rosbag 2.0 bag"
//   if (const auto kind = lasting_kind("a.bag")) print(*kind);              // the same, of a file
//
// Complexity: O(1). Sources: the formats' own descriptions, named in file_kind.cc.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace simbench {

// How bags begin.
inline constexpr std::string_view kRosbagMagic = "#ROSBAG V2.0";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

struct FileKind {
  std::string_view what{};     // as a message calls it
  bool holds_another = false;  // compressed by gzip, zstd, bzip2 or LZ4: text may be in it
  bool is_video = false;       // a container of tracks with frames
  std::string_view help{};     // what makes a text of it; may be empty
};

// How many first bytes tell all kinds apart.
inline constexpr std::size_t kFileKindBytes = 16;

// Nothing for text and for what is not known.
std::optional<FileKind> file_kind(std::string_view first_bytes);

// Whether a file holds what no run can make again: a recording, or other data that are no text. A
// text that a run has written (a table, a page, a scenario) and a PDF are of no such kind; text
// that is known as a recording is: the CSV of librealsense's rs-data-collect and the frames of a
// recording folder. A file that cannot be read may be anything, so it has a kind too. What is no
// regular file has none.
std::optional<std::string_view> lasting_kind(const std::string& path);

}  // namespace simbench
