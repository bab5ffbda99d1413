// Bytes as compressors write them: "lz4", "zstd", "bz2", "gzip"; "" leaves them as they are, as
// does a name that no reader knows.
//
//   const std::string packed = deflated("gzip", "time_s,offset_ns\n");
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace simbench {

inline std::string lz4_deflated(std::string_view plain) {
  std::string out(LZ4F_compressFrameBound(plain.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr));
  return out;
}

inline std::string zstd_deflated(std::string_view plain) {
  std::string out(ZSTD_compressBound(plain.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  return out;
}

inline std::string bzip2_deflated(std::string_view plain) {
  std::string copy(plain);
  auto size = static_cast<unsigned>(plain.size() + plain.size() / 100 + 600);
  std::string out(size, '\0');
  if (BZ2_bzBuffToBuffCompress(out.data(), &size, copy.data(), static_cast<unsigned>(copy.size()),
                               1, 0, 0) != BZ_OK) {
    throw std::runtime_error("bzip2 does not compress");
  }
  out.resize(size);
  return out;
}

inline std::string gzip_deflated(std::string_view plain) {
  constexpr int kGzipHead = 16;  // added to the size of the window
  z_stream stream{};
  std::string copy(plain);
  std::string out(plain.size() + plain.size() / 100 + 600, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(copy.data());
  stream.avail_in = static_cast<unsigned>(copy.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<unsigned>(out.size());
  const bool begun =
      deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + kGzipHead, 8, Z_DEFAULT_STRATEGY) == Z_OK;
  const bool done = begun && deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(stream.total_out);
  if (begun) deflateEnd(&stream);
  if (!done) throw std::runtime_error("zlib does not compress");
  return out;
}

inline std::string deflated(std::string_view compression, std::string_view plain) {
  if (compression == "lz4") return lz4_deflated(plain);
  if (compression == "zstd") return zstd_deflated(plain);
  if (compression == "bz2") return bzip2_deflated(plain);
  if (compression == "gzip") return gzip_deflated(plain);
  return std::string(plain);
}

}  // namespace simbench
