// Bytes in order, of a file or of a compressed part of one, of which most are skipped.
//
// Memory: a buffer of 16 kB for a file; for compressed bytes 128 kB, and what the format looks back
// to (LZ4 64 kB, gzip 32 kB, bzip2 4 MB, zstd up to 64 MB, a frame that needs more is refused).
//
//   char buffer[8];
//   const std::uint64_t compressed_size = 512;
//   FileBytes file("rig.bag");
//   file.seek(4096);
//   LimitedBytes chunk(file, compressed_size);
//   const std::unique_ptr<ByteStream> plain = inflated(Compression::kLz4, chunk);
//   plain->skip(100);
//   if (!plain->read_exactly(buffer, 8)) ...    // the end came first
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scenarios/input_file.h"

namespace simbench {

// Compressed bytes that are damaged; what() is the reason alone.
class InflateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ByteStream {
 public:
  virtual ~ByteStream() = default;
  // Returns the number of bytes read, 1 to `most`; 0 only at the end, or if `most` is 0.
  virtual std::size_t read(char* to, std::size_t most) = 0;
  // Returns how many bytes were skipped, fewer than `count` only at the end.
  virtual std::uint64_t skip(std::uint64_t count) = 0;

  // Reads on until `count` bytes are there or the end comes. Returns how many there are.
  std::size_t read_up_to(char* to, std::size_t count);
  // False if the end comes first; what there was is read all the same.
  bool read_exactly(char* to, std::size_t count) { return read_up_to(to, count) == count; }
};

// A file; a pipe is none, since it has no positions. Throws FileError.
class FileBytes final : public ByteStream {
 public:
  explicit FileBytes(const std::string& path, Pipes pipes = Pipes::kRefused) : file_(path, pipes) {}
  std::size_t read(char* to, std::size_t most) override;
  std::uint64_t skip(std::uint64_t count) override;

  std::uint64_t size() const { return file_.size(); }
  std::uint64_t position() const { return position_; }
  void seek(std::uint64_t position);

 private:
  std::size_t buffered() const { return end_ - begin_; }

  InputFile file_;
  std::array<char, std::size_t{16} << 10> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t position_ = 0;  // of the next byte that read() gives
};

// The next `count` bytes of another stream, which outlives this.
class LimitedBytes final : public ByteStream {
 public:
  LimitedBytes(ByteStream& from, std::uint64_t count) : from_(from), left_(count) {}
  std::size_t read(char* to, std::size_t most) override;
  std::uint64_t skip(std::uint64_t count) override;
  std::uint64_t left() const { return left_; }

 private:
  ByteStream& from_;
  std::uint64_t left_;
};

// Bytes in memory, which outlive this.
class MemoryBytes final : public ByteStream {
 public:
  explicit MemoryBytes(std::string_view bytes) : bytes_(bytes) {}
  std::size_t read(char* to, std::size_t most) override;
  std::uint64_t skip(std::uint64_t count) override;

 private:
  std::string_view bytes_;
};

// How many bytes a file that is compressed as a whole, a text or a bag, may become, by how many of
// its own were read: logs are 10 to 50 times as long.
inline constexpr std::uint64_t kMostInflation = 128;
constexpr std::uint64_t most_inflated(std::uint64_t compressed_bytes) {
  return (std::uint64_t{64} << 20) + kMostInflation * compressed_bytes;
}

enum class Compression : std::uint8_t { kLz4, kZstd, kBzip2, kGzip };

// The plain bytes of a compressed stream (of all but bzip2: of frames, one after another), which
// outlives this. Reading throws InflateError for bytes that are damaged or end too early.
std::unique_ptr<ByteStream> inflated(Compression compression, ByteStream& compressed);

}  // namespace simbench
