// The text of a file in the forms in which people keep it, as UTF-8: plain, compressed (gzip, zstd,
// bzip2, LZ4, each by its first bytes and not by its name), with a byte order mark, and in UTF-16,
// as PowerShell writes it. "-" is standard input.
//
// A compressed file may become 64 MiB and 128 bytes for each of its own. A file of another kind is
// refused by what it is ("a Matroska file"). Half a surrogate pair becomes U+FFFD.
//
// Errors: FileError, with the reason alone, at the beginning or where the file is damaged.
// Complexity: linear; memory: two buffers of 64 kB, and what decompression looks back to
// (recording/byte_stream.h).
//
//   char buffer[4096];
//   TextFile file("ptp4l.log.gz");
//   while (const std::size_t size = file.read(buffer, sizeof buffer)) use(buffer, size);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "scenarios/input_file.h"

namespace simbench {

class TextFile {
 public:
  explicit TextFile(const std::string& path, Pipes pipes = Pipes::kRead);
  ~TextFile();
  TextFile(TextFile&&) noexcept;
  TextFile& operator=(TextFile&&) noexcept;

  // Returns the number of bytes read, 1 to `most` (at least 4); 0 only at the end.
  std::size_t read(char* to, std::size_t most);
  // The size of the file itself, compressed or not, 0 if that is unknown, and what was read of it.
  std::uint64_t size() const;
  std::uint64_t bytes_read() const;

 private:
  class Layers;
  std::unique_ptr<Layers> layers_;
};

}  // namespace simbench
