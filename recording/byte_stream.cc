#include "recording/byte_stream.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace simbench {
namespace {

constexpr std::size_t kInflateBuffer = std::size_t{64} << 10;
constexpr int kLargestZstdWindowLog = 26;  // 64 MB

// What decompressors have in common: compressed bytes in one buffer, plain ones in another, so that
// reading and skipping a few bytes costs little.
class Inflater : public ByteStream {
 public:
  explicit Inflater(ByteStream& compressed)
      : compressed_(compressed), input_(kInflateBuffer), plain_(kInflateBuffer) {}

  std::size_t read(char* to, std::size_t most) override {
    if (most == 0 || !refill()) return 0;
    const std::size_t size = std::min(most, plain_end_ - plain_begin_);
    std::memcpy(to, plain_.data() + plain_begin_, size);
    plain_begin_ += size;
    return size;
  }

  std::uint64_t skip(std::uint64_t count) override {
    std::uint64_t done = 0;
    while (done < count && refill()) {
      const auto size = static_cast<std::size_t>(
          std::min<std::uint64_t>(count - done, plain_end_ - plain_begin_));
      plain_begin_ += size;
      done += size;
    }
    return done;
  }

 protected:
  // Returns 1 to `most` plain bytes; 0 only at the end.
  virtual std::size_t inflate(char* to, std::size_t most) = 0;

  // False at the end of the compressed bytes.
  bool fill() {
    if (begin_ < end_) return true;
    begin_ = 0;
    end_ = compressed_.read(input_.data(), input_.size());
    return end_ > 0;
  }
  char* next() { return input_.data() + begin_; }
  std::size_t left() const { return end_ - begin_; }
  void consume(std::size_t size) { begin_ += size; }

 private:
  // False at the end of the plain bytes.
  bool refill() {
    if (plain_begin_ < plain_end_) return true;
    plain_begin_ = 0;
    plain_end_ = inflate(plain_.data(), plain_.size());
    return plain_end_ > 0;
  }

  ByteStream& compressed_;
  std::vector<char> input_;
  std::vector<char> plain_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t plain_begin_ = 0;
  std::size_t plain_end_ = 0;
};

class Lz4Inflater final : public Inflater {
 public:
  explicit Lz4Inflater(ByteStream& compressed) : Inflater(compressed) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0U) {
      throw std::bad_alloc();
    }
    context_.reset(context);
  }

  std::size_t inflate(char* to, std::size_t most) override {
    while (true) {
      if (!fill()) {
        if (wanted_ == 0) return 0;
        throw InflateError("LZ4: the compressed bytes end too early");
      }
      std::size_t given = most;
      std::size_t taken = left();
      const std::size_t result =
          LZ4F_decompress(context_.get(), to, &given, next(), &taken, nullptr);
      if (LZ4F_isError(result) != 0U) {
        throw InflateError(std::string("LZ4: ") + LZ4F_getErrorName(result));
      }
      if (given == 0 && taken == 0) throw InflateError("LZ4: the compressed bytes make no sense");
      consume(taken);
      wanted_ = result;
      if (given > 0) return given;
    }
  }

 private:
  struct Free {
    void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
  };
  std::unique_ptr<LZ4F_dctx, Free> context_;
  std::size_t wanted_ = 0;  // 0: between two frames
};

class ZstdInflater final : public Inflater {
 public:
  explicit ZstdInflater(ByteStream& compressed)
      : Inflater(compressed), context_(ZSTD_createDCtx()) {
    if (!context_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kLargestZstdWindowLog);
  }

  std::size_t inflate(char* to, std::size_t most) override {
    ZSTD_outBuffer output{to, most, 0};
    while (true) {
      // Plain bytes may be left inside that need no further compressed ones.
      const bool more = fill();
      ZSTD_inBuffer input{next(), left(), 0};
      const std::size_t result = ZSTD_decompressStream(context_.get(), &output, &input);
      if (ZSTD_isError(result) != 0U) {
        throw InflateError(std::string("zstd: ") + ZSTD_getErrorName(result));
      }
      consume(input.pos);
      if (input.pos > 0 || output.pos > 0) wanted_ = result;
      if (output.pos > 0) return output.pos;
      if (more) continue;
      if (wanted_ == 0) return 0;
      throw InflateError("zstd: the compressed bytes end too early");
    }
  }

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> context_;
  std::size_t wanted_ = 0;  // 0: between two frames
};

class Bzip2Inflater final : public Inflater {
 public:
  explicit Bzip2Inflater(ByteStream& compressed) : Inflater(compressed) {
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  ~Bzip2Inflater() override { BZ2_bzDecompressEnd(&stream_); }
  Bzip2Inflater(const Bzip2Inflater&) = delete;
  Bzip2Inflater& operator=(const Bzip2Inflater&) = delete;

  std::size_t inflate(char* to, std::size_t most) override {
    while (!ended_) {
      const bool more = fill();
      stream_.next_in = next();
      stream_.avail_in = static_cast<unsigned>(left());
      stream_.next_out = to;
      stream_.avail_out = static_cast<unsigned>(std::min<std::size_t>(most, kInflateBuffer));
      const unsigned room = stream_.avail_out;
      const int result = BZ2_bzDecompress(&stream_);
      consume(left() - stream_.avail_in);
      ended_ = result == BZ_STREAM_END;
      if (result != BZ_OK && !ended_) throw InflateError("bzip2: the compressed bytes are damaged");
      if (stream_.avail_out < room) return room - stream_.avail_out;
      if (!more && !ended_) throw InflateError("bzip2: the compressed bytes end too early");
    }
    return 0;
  }

 private:
  bz_stream stream_{};
  bool ended_ = false;
};

class GzipInflater final : public Inflater {
 public:
  explicit GzipInflater(ByteStream& compressed) : Inflater(compressed) {
    constexpr int kGzipWindowBits = 15 + 16;  // the largest window, with gzip's head
    if (inflateInit2(&stream_, kGzipWindowBits) != Z_OK) throw std::bad_alloc();
  }
  ~GzipInflater() override { inflateEnd(&stream_); }
  GzipInflater(const GzipInflater&) = delete;
  GzipInflater& operator=(const GzipInflater&) = delete;

  std::size_t inflate(char* to, std::size_t most) override {
    while (true) {
      if (!fill()) {
        if (between_members_) return 0;
        throw InflateError("gzip: the compressed bytes end too early");
      }
      stream_.next_in = reinterpret_cast<Bytef*>(next());
      stream_.avail_in = static_cast<unsigned>(left());
      stream_.next_out = reinterpret_cast<Bytef*>(to);
      stream_.avail_out = static_cast<unsigned>(std::min<std::size_t>(most, kInflateBuffer));
      const unsigned room = stream_.avail_out;
      const int result = ::inflate(&stream_, Z_NO_FLUSH);
      consume(left() - stream_.avail_in);
      between_members_ = result == Z_STREAM_END;
      if (result != Z_OK && !between_members_) {
        throw InflateError("gzip: the compressed bytes are damaged");
      }
      if (between_members_) inflateReset(&stream_);
      if (stream_.avail_out < room) return room - stream_.avail_out;
    }
  }

 private:
  z_stream stream_{};
  bool between_members_ = false;
};

}  // namespace

std::size_t ByteStream::read_up_to(char* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const std::size_t size = read(to + done, count - done);
    if (size == 0) break;
    done += size;
  }
  return done;
}

std::size_t FileBytes::read(char* to, std::size_t most) {
  if (most == 0) return 0;
  if (buffered() == 0 && most >= buffer_.size()) {
    const std::size_t size = file_.read(to, most);
    begin_ = end_ = 0;
    position_ += size;
    return size;
  }
  if (buffered() == 0) {
    begin_ = 0;
    end_ = file_.read(buffer_.data(), buffer_.size());
  }
  const std::size_t size = std::min(most, buffered());
  std::memcpy(to, buffer_.data() + begin_, size);
  begin_ += size;
  position_ += size;
  return size;
}

std::uint64_t FileBytes::skip(std::uint64_t count) {
  if (count <= buffered()) {
    begin_ += static_cast<std::size_t>(count);
    position_ += count;
    return count;
  }
  const std::uint64_t left = position_ < size() ? size() - position_ : 0;
  const std::uint64_t skipped = std::min(count, left);
  seek(position_ + skipped);
  return skipped;
}

void FileBytes::seek(std::uint64_t position) {
  // What is at hand is not read again.
  const std::uint64_t first = position_ - begin_;
  if (position >= first && position - first < end_) {
    begin_ = static_cast<std::size_t>(position - first);
    position_ = position;
    return;
  }
  file_.seek(position);
  begin_ = end_ = 0;
  position_ = position;
}

std::size_t LimitedBytes::read(char* to, std::size_t most) {
  const std::size_t size =
      from_.read(to, static_cast<std::size_t>(std::min<std::uint64_t>(most, left_)));
  left_ -= size;
  return size;
}

std::uint64_t LimitedBytes::skip(std::uint64_t count) {
  const std::uint64_t skipped = from_.skip(std::min(count, left_));
  left_ -= skipped;
  return skipped;
}

std::size_t MemoryBytes::read(char* to, std::size_t most) {
  const std::size_t size = std::min(most, bytes_.size());
  if (size == 0) return 0;
  std::memcpy(to, bytes_.data(), size);
  bytes_.remove_prefix(size);
  return size;
}

std::uint64_t MemoryBytes::skip(std::uint64_t count) {
  const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes_.size()));
  bytes_.remove_prefix(skipped);
  return skipped;
}

std::unique_ptr<ByteStream> inflated(Compression compression, ByteStream& compressed) {
  switch (compression) {
    case Compression::kLz4:
      return std::make_unique<Lz4Inflater>(compressed);
    case Compression::kZstd:
      return std::make_unique<ZstdInflater>(compressed);
    case Compression::kBzip2:
      return std::make_unique<Bzip2Inflater>(compressed);
    case Compression::kGzip:
      return std::make_unique<GzipInflater>(compressed);
  }
  return nullptr;
}

}  // namespace simbench
