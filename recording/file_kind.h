// What a file is by its first bytes: for messages about files that are not what was asked for, and
// for files that must not be written over.
//
//   if (const auto kind = file_kind("#ROSBAG V2.0")) print(kind->what);   // "a bag of ROS 1"
//
// Sources: the formats' own specifications, as in the file(1) database.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace simbench {

struct FileKind {
  enum class Use : std::uint8_t { kCompressed, kRecording, kOther };
  const char* what;  // "a Matroska video (MKV, WebM)"
  Use use = Use::kOther;
};

// How many first bytes tell all kinds apart.
inline constexpr std::size_t kFileKindBytes = 16;

// Nothing for text and for what is not known.
std::optional<FileKind> file_kind(std::string_view first_bytes);

}  // namespace simbench
