#include "recording/file_kind.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include "scenarios/input_file.h"

namespace simbench {
namespace {

using namespace std::string_view_literals;

// Enough for any of the magics, and for a NUL in data that have none.
constexpr std::size_t kLookedAt = 4096;

struct Magic {
  std::string_view bytes;
  std::string_view kind;
  std::size_t at = 0;
};

// rosbag: wiki.ros.org/Bags/Format/2.0; MCAP: mcap.dev/spec; SQLite: sqlite.org/fileformat.html;
// NPY: numpy.lib.format; Matroska: RFC 8794; MP4: ISO/IEC 14496-12; HDF5: its file format
// specification, III.A; zip: PKWARE's APPNOTE; gzip: RFC 1952; zstd: RFC 8878; pcap:
// draft-ietf-opsawg-pcap; rs-data-collect: recording/rs_csv.h; frames:
// recording/recording_folder.h.
constexpr std::array kMagics = {Magic{kRosbagMagic, "a rosbag 2.0 bag"},
                                Magic{kMcapMagic, "an MCAP file"},
                                Magic{kSqliteMagic, "an SQLite file"},
                                Magic{"\x93NUMPY", "a NumPy array"},
                                Magic{"\x1a\x45\xdf\xa3", "a Matroska file"},
                                Magic{"ftyp", "an MP4 file", 4},
                                Magic{"\x89HDF\r\n\x1a\n", "an HDF5 file"},
                                Magic{"PK\x03\x04", "a zip file"},
                                Magic{"PK\x05\x06", "a zip file"},
                                Magic{"\x1f\x8b", "a gzip file"},
                                Magic{"\x28\xb5\x2f\xfd", "a zstd file"},
                                Magic{"\x7f"
                                      "ELF",
                                      "a program"},
                                Magic{"\xd4\xc3\xb2\xa1", "a pcap file"},
                                Magic{"\xa1\xb2\xc3\xd4", "a pcap file"},
                                Magic{"\x4d\x3c\xb2\xa1", "a pcap file"},
                                Magic{"\xa1\xb2\x3c\x4d", "a pcap file"},
                                Magic{"\x0a\x0d\x0d\x0a", "a pcapng file"},
                                Magic{"Stream Type,", "a CSV recording"},
                                Magic{"order,camera,", "a part of a recording folder"}};

std::optional<std::string_view> kind_of(std::string_view first) {
  for (const Magic& magic : kMagics) {
    if (first.size() > magic.at && first.substr(magic.at).starts_with(magic.bytes)) {
      return magic.kind;
    }
  }
  const bool is_text = first.find('\0') == std::string_view::npos || first.starts_with("%PDF");
  return is_text ? std::nullopt : std::optional("a binary file"sv);
}

}  // namespace

std::optional<std::string_view> lasting_kind(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return std::nullopt;
  std::array<char, kLookedAt> first{};
  std::size_t size = 0;
  try {
    InputFile file(path, Pipes::kRefused);
    while (const std::size_t more = file.read(first.data() + size, first.size() - size)) {
      size += more;
      if (size == first.size()) break;
    }
  } catch (const FileError&) {
    return "a file that cannot be read";
  }
  return kind_of({first.data(), size});
}

}  // namespace simbench
