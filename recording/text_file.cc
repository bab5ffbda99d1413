#include "recording/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/byte_stream.h"
#include "recording/file_kind.h"
#include "scenarios/input_file.h"

namespace simbench {
namespace {

constexpr std::size_t kTextBlock = std::size_t{64} << 10;
constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
constexpr std::uint32_t kReplacement = 0xfffd;

std::optional<Compression> compression_of(std::string_view first_bytes) {
  switch (first_bytes.empty() ? '\0' : first_bytes.front()) {
    case '\x1f':
      return Compression::kGzip;
    case '\x28':
      return Compression::kZstd;
    case 'B':
      return Compression::kBzip2;
    case '\x04':
      return Compression::kLz4;
    default:
      return std::nullopt;
  }
}

char* append_utf8(char* to, std::uint32_t code) {
  const auto tail = [&](int shift) {
    *to++ = static_cast<char>(0x80U | ((code >> shift) & 0x3fU));
  };
  if (code < 0x80) {
    *to++ = static_cast<char>(code);
  } else if (code < 0x800) {
    *to++ = static_cast<char>(0xc0U | (code >> 6U));
    tail(0);
  } else if (code < 0x10000) {
    *to++ = static_cast<char>(0xe0U | (code >> 12U));
    tail(6);
    tail(0);
  } else {
    *to++ = static_cast<char>(0xf0U | (code >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
  return to;
}

// A stream whose first bytes can be looked at before they are read.
class FirstBytes final : public ByteStream {
 public:
  explicit FirstBytes(ByteStream& from) : from_(from) {}

  std::string_view look() {
    if (end_ == 0) end_ = from_.read_up_to(first_.data(), first_.size());
    return {first_.data(), end_};
  }

  std::size_t read(char* to, std::size_t most) override {
    if (begin_ == end_) return from_.read(to, most);
    const std::size_t size = std::min(most, end_ - begin_);
    std::memcpy(to, first_.data() + begin_, size);
    begin_ += size;
    return size;
  }

  std::uint64_t skip(std::uint64_t count) override {
    const std::uint64_t held = std::min<std::uint64_t>(count, end_ - begin_);
    begin_ += static_cast<std::size_t>(held);
    return held + (count > held ? from_.skip(count - held) : 0);
  }

 private:
  ByteStream& from_;
  std::array<char, kFileKindBytes> first_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

// Turns UTF-16 into UTF-8.
class Utf16 {
 public:
  explicit Utf16(bool big_endian) : big_endian_(big_endian), units_(kTextBlock) {}

  std::size_t read(ByteStream& from, char* to, std::size_t most) {
    char* const begin = to;
    while (to == begin && refill(from)) {
      // One unit becomes three bytes at most, two that are a pair four.
      while (begin_ + 1 < end_ && to - begin + 4 <= static_cast<std::ptrdiff_t>(most)) {
        to = take(to);
      }
    }
    if (to == begin && pending_ != 0) {
      pending_ = 0;
      to = append_utf8(to, kReplacement);
    }
    return static_cast<std::size_t>(to - begin);
  }

 private:
  // False at the end; a last odd byte is left out.
  bool refill(ByteStream& from) {
    if (begin_ + 1 < end_) return true;
    const std::size_t rest = end_ - begin_;
    if (rest > 0) units_[0] = units_[begin_];
    begin_ = 0;
    end_ = rest + from.read_up_to(units_.data() + rest, units_.size() - rest);
    return end_ >= 2;
  }

  char* take(char* to) {
    const auto first = static_cast<unsigned char>(units_[begin_]);
    const auto second = static_cast<unsigned char>(units_[begin_ + 1]);
    begin_ += 2;
    const std::uint32_t unit = big_endian_ ? (first << 8U) | second : (second << 8U) | first;
    const bool low = unit >= 0xdc00 && unit < 0xe000;
    if (pending_ != 0) {
      const std::uint32_t high = std::exchange(pending_, 0);
      if (low) return append_utf8(to, 0x10000 + ((high - 0xd800) << 10U) + (unit - 0xdc00));
      begin_ -= 2;
      return append_utf8(to, kReplacement);
    }
    if (unit >= 0xd800 && unit < 0xdc00) {
      pending_ = unit;
      return to;
    }
    return append_utf8(to, low ? kReplacement : unit);
  }

  bool big_endian_;
  std::vector<char> units_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint32_t pending_ = 0;  // the first half of a pair
};

// The byte order of UTF-16, by its mark or by the zeros of Latin letters.
std::optional<bool> utf16_is_big_endian(std::string_view first) {
  if (first.starts_with("\xff\xfe")) return false;
  if (first.starts_with("\xfe\xff")) return true;
  if (first.size() < 4) return std::nullopt;
  const auto zero = [&](std::size_t at) { return first[at] == '\0'; };
  if (!zero(0) && zero(1) && !zero(2) && zero(3)) return false;
  if (zero(0) && !zero(1) && zero(2) && !zero(3)) return true;
  return std::nullopt;
}

std::size_t mark_size(std::string_view first) {
  if (first.starts_with("\xff\xfe") || first.starts_with("\xfe\xff")) return 2;
  return first.starts_with(kUtf8Mark) ? kUtf8Mark.size() : 0;
}

}  // namespace

// From the file's bytes to those of its text.
class TextFile::Layers {
 public:
  Layers(const std::string& path, Pipes pipes)
      : file_(path == "-" ? "/dev/stdin" : path, pipes), packed_(file_) {
    const std::string_view first = packed_.look();
    if (const std::optional<FileKind> kind = file_kind(first)) {
      if (!kind->holds_another) {
        throw FileError(fmt::format("it is {}, no text{}{}", kind->what,
                                    kind->help.empty() ? "" : "; ", kind->help));
      }
      inflated_ = inflated(*compression_of(first), packed_);
    }
    plain_.emplace(inflated_ ? *inflated_ : packed_);
    const std::string_view begin = plain_->look();
    const std::optional<bool> big_endian = utf16_is_big_endian(begin);
    plain_->skip(mark_size(begin));
    if (big_endian) utf16_.emplace(*big_endian);
  }

  std::size_t read(char* to, std::size_t most) {
    const std::size_t size = utf16_ ? utf16_->read(*plain_, to, most) : plain_->read(to, most);
    text_bytes_ += size;
    if (inflated_ && text_bytes_ > most_inflated(file_.position())) {
      throw FileError(fmt::format("it becomes more than {} times as long when inflated; unpack it",
                                  kMostInflation));
    }
    return size;
  }
  const FileBytes& file() const { return file_; }

 private:
  FileBytes file_;
  FirstBytes packed_;
  std::unique_ptr<ByteStream> inflated_{};
  std::optional<FirstBytes> plain_{};
  std::optional<Utf16> utf16_{};
  std::uint64_t text_bytes_ = 0;
};

namespace {

// A damaged file is as unreadable as one on a damaged disk.
template <class Action>
auto readable(const Action& action) {
  try {
    return action();
  } catch (const InflateError& error) {
    throw FileError(error.what());
  }
}

}  // namespace

TextFile::TextFile(const std::string& path, Pipes pipes)
    : layers_(readable([&] { return std::make_unique<Layers>(path, pipes); })) {}

TextFile::~TextFile() = default;
TextFile::TextFile(TextFile&&) noexcept = default;
TextFile& TextFile::operator=(TextFile&&) noexcept = default;

std::size_t TextFile::read(char* to, std::size_t most) {
  return readable([&] { return layers_->read(to, most); });
}

std::uint64_t TextFile::size() const { return layers_->file().size(); }
std::uint64_t TextFile::bytes_read() const { return layers_->file().position(); }

}  // namespace simbench
