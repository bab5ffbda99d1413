// Whether a file holds what no run can make again: a recording, or other data that are no text.
//
// By the first bytes, not by the name. A text that a run has written (a table, a page, a scenario)
// and a PDF are of no such kind; text that is known as a recording is: the CSV of librealsense's
// rs-data-collect and the frames of a recording folder. A file that cannot be read may be anything,
// so it has a kind too. What is no regular file has none.
//
//   if (const auto kind = lasting_kind("a.bag")) print(*kind);    // "a rosbag 2.0 bag"
//
// Complexity: O(1). Source: the formats' own descriptions, named in file_kind.cc.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace simbench {

// How bags begin.
inline constexpr std::string_view kRosbagMagic = "#ROSBAG V2.0";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};

// What a message calls it.
std::optional<std::string_view> lasting_kind(const std::string& path);

}  // namespace simbench
