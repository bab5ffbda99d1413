#include "recording/file_kind.h"

#include <array>

namespace simbench {
namespace {

using Use = FileKind::Use;

struct Signature {
  std::size_t at;
  std::string_view bytes;
  FileKind kind;
};

constexpr auto kSignatures = std::to_array<Signature>({
    {0, "\x1f\x8b", {"a gzip file", Use::kCompressed}},
    {0, "\x28\xb5\x2f\xfd", {"a zstd file", Use::kCompressed}},
    {0, "BZh", {"a bzip2 file", Use::kCompressed}},
    {0, "\x04\x22\x4d\x18", {"an LZ4 file", Use::kCompressed}},
    {0, {"\xfd\x37zXZ\0", 6}, {"an xz file", Use::kOther}},
    {0, "7z\xbc\xaf\x27\x1c", {"a 7-Zip archive", Use::kOther}},
    {0, "PK\x03\x04", {"a zip archive (npz, xlsx)", Use::kRecording}},
    {0, "#ROSBAG", {"a bag of ROS 1", Use::kRecording}},
    {0, "\x89MCAP", {"an MCAP bag", Use::kRecording}},
    {0, "SQLite format 3", {"an SQLite database (a bag of ROS 2)", Use::kRecording}},
    {0, "\x93NUMPY", {"an array of NumPy (npy)", Use::kRecording}},
    {0, "PAR1", {"a Parquet file", Use::kRecording}},
    {0, "XDF:", {"an XDF recording", Use::kRecording}},
    {0, "\x89HDF", {"an HDF5 file", Use::kRecording}},
    {0, "\x1a\x45\xdf\xa3", {"a Matroska video (MKV, WebM)", Use::kRecording}},
    {4, "ftyp", {"an MP4 or MOV video", Use::kRecording}},
    {0, "RIFF", {"an AVI or WAV file", Use::kRecording}},
    {0, "OggS", {"an Ogg file", Use::kRecording}},
    {0, "\xd4\xc3\xb2\xa1", {"a capture of packets (pcap)", Use::kRecording}},
    {0, "\x4d\x3c\xb2\xa1", {"a capture of packets (pcap)", Use::kRecording}},
    {0, "\x0a\x0d\x0d\x0a", {"a capture of packets (pcapng)", Use::kRecording}},
    {0, "LPKSHHRH", {"a journal of systemd; journalctl --file prints it", Use::kRecording}},
    {0, "ElfFile", {"an event log of Windows", Use::kRecording}},
    {0,
     "\x7f"
     "ELF",
     {"a program (ELF)", Use::kOther}},
    {0, "\x89PNG", {"a PNG picture", Use::kOther}},
    {0, "\xff\xd8\xff", {"a JPEG picture", Use::kOther}},
    {0, "%PDF", {"a PDF document", Use::kOther}},
});

}  // namespace

std::optional<FileKind> file_kind(std::string_view first_bytes) {
  for (const Signature& signature : kSignatures) {
    if (first_bytes.size() < signature.at) continue;
    if (first_bytes.substr(signature.at).starts_with(signature.bytes)) return signature.kind;
  }
  return std::nullopt;
}

}  // namespace simbench
