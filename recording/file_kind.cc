#include "recording/file_kind.h"

#include <array>
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
  FileKind kind;
  std::size_t at = 0;
};

// Behind the length of a box of MP4 and QuickTime, four bytes of which the first is 0 (a length
// beyond 16 MB is written elsewhere): a text such as "cam_wide,..." is none.
constexpr std::size_t kBoxType = 4;
constexpr FileKind kQuickTime{.what = "a QuickTime file", .is_video = true};
constexpr std::string_view kByPython =
    "simbench.write_recording() of the Python package makes a CSV of it";

// rosbag: wiki.ros.org/Bags/Format/2.0; MCAP: mcap.dev/spec; SQLite: sqlite.org/fileformat.html;
// NPY: numpy.lib.format; Parquet and XDF: their specifications; Matroska: RFC 8794; MP4: ISO/IEC
// 14496-12; HDF5: its file format specification, III.A; zip: PKWARE's APPNOTE; gzip: RFC 1952;
// zstd: RFC 8878; LZ4: its frame format; pcap: draft-ietf-opsawg-pcap; journals: systemd's
// JOURNAL_FILE_FORMAT.
constexpr auto kMagics = std::to_array<Magic>({
    {kRosbagMagic, {"a rosbag 2.0 bag"}},
    {kMcapMagic, {"an MCAP file"}},
    {kSqliteMagic, {"an SQLite file"}},
    {"\x93NUMPY", {.what = "a NumPy array", .help = kByPython}},
    {"PAR1", {.what = "a Parquet file", .help = kByPython}},
    {"XDF:", {.what = "an XDF file", .help = kByPython}},
    {"\x1a\x45\xdf\xa3", {.what = "a Matroska file", .is_video = true}},
    {"ftyp", {.what = "an MP4 file", .is_video = true}, kBoxType},
    {"moov", kQuickTime, kBoxType},
    {"mdat", kQuickTime, kBoxType},
    {"wide", kQuickTime, kBoxType},
    {"RIFF", {.what = "an AVI or WAV file", .is_video = true}},
    {"\x89HDF\r\n\x1a\n", {"an HDF5 file"}},
    {"PK\x03\x04",
     {.what = "a zip file",
      .help = "of an .npz, simbench.write_recording() of the Python package makes a CSV"}},
    {"PK\x05\x06", {"a zip file"}},
    {"\xfd\x37zXZ\0"sv, {"an xz file"}},
    {"7z\xbc\xaf\x27\x1c", {"a 7-Zip file"}},
    {"\x1f\x8b", {"a gzip file", true}},
    {"\x28\xb5\x2f\xfd", {"a zstd file", true}},
    {"BZh", {"a bzip2 file", true}},
    {"\x04\x22\x4d\x18", {"an LZ4 file", true}},
    {"LPKSHHRH", {"a journal of systemd (journalctl --file prints it)"}},
    {"ElfFile", {"an event log of Windows"}},
    {"\x7f"
     "ELF",
     {"a program"}},
    {"\xd4\xc3\xb2\xa1", {"a pcap file"}},
    {"\xa1\xb2\xc3\xd4", {"a pcap file"}},
    {"\x4d\x3c\xb2\xa1", {"a pcap file"}},
    {"\xa1\xb2\x3c\x4d", {"a pcap file"}},
    {"\x0a\x0d\x0d\x0a", {"a pcapng file"}},
    {"\x89PNG", {"a PNG picture"}},
    {"\xff\xd8\xff", {"a JPEG picture"}},
    {"%PDF", {"a PDF document"}},
});

// Text that is a recording: recording/rs_csv.h, recording/recording_folder.h.
constexpr std::array<Magic, 2> kTexts = {
    {{"Stream Type,", {"a CSV recording"}}, {"order,camera,", {"a part of a recording folder"}}}};

template <class Magics>
std::optional<FileKind> kind_among(const Magics& magics, std::string_view first) {
  for (const Magic& magic : magics) {
    if (first.size() <= magic.at || !first.substr(magic.at).starts_with(magic.bytes)) continue;
    if (magic.at == kBoxType && first.front() != '\0') continue;
    return magic.kind;
  }
  return std::nullopt;
}

std::optional<std::string_view> lasting_kind_of(std::string_view first) {
  if (first.starts_with("%PDF")) return std::nullopt;
  if (const auto kind = file_kind(first)) return kind->what;
  if (const auto kind = kind_among(kTexts, first)) return kind->what;
  const bool is_text = first.find('\0') == std::string_view::npos;
  return is_text ? std::nullopt : std::optional("a binary file"sv);
}

}  // namespace

std::optional<FileKind> file_kind(std::string_view first_bytes) {
  return kind_among(kMagics, first_bytes);
}

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
  return lasting_kind_of({first.data(), size});
}

}  // namespace simbench
