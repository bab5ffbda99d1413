// How much a file may become: compressed bytes can be made to stand for hours of work and for more
// than any memory.
//
// A file of n bytes may have a million messages and one more for every 16 bytes, and 1 GiB of plain
// bytes and 256 more for each; bzip2, which is slow, an eighth of that. A recorder's files stay far
// below: a message's stamps alone take more. What comes beyond ends the reading, with a note.
//
//   ReadBudget budget(file.size());
//   BudgetedBytes plain(*inflated(Compression::kZstd, chunk), declared, budget);
//   budget.take_message();      // throws BudgetSpent
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "recording/byte_stream.h"

namespace simbench::bags {

// what() says which limit it was.
class BudgetSpent : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ReadBudget {
 public:
  explicit ReadBudget(std::uint64_t file_bytes)
      : most_messages_(kLeastMessages + file_bytes / kBytesAMessage),
        most_plain_(kLeastPlain + file_bytes * kPlainAByte),
        messages_(most_messages_),
        plain_(most_plain_) {}

  void take_message() {
    if (messages_ == 0) fail(most_messages_, "messages");
    --messages_;
  }
  // `weight`: how much slower than zstd and LZ4 these are made.
  void take_plain(std::uint64_t bytes, std::uint64_t weight = 1) {
    if (bytes > plain_ / weight) fail(most_plain_ / weight, "bytes when inflated");
    plain_ -= bytes * weight;
  }

 private:
  static constexpr std::uint64_t kLeastMessages = 1'000'000;
  static constexpr std::uint64_t kBytesAMessage = 16;
  static constexpr std::uint64_t kLeastPlain = std::uint64_t{1} << 30;
  static constexpr std::uint64_t kPlainAByte = 256;

  [[noreturn]] static void fail(std::uint64_t most, const char* things) {
    throw BudgetSpent("found more than " + std::to_string(most) + " " + things +
                      ", which is the limit for a file of this size; the rest was left out");
  }

  std::uint64_t most_messages_;
  std::uint64_t most_plain_;
  std::uint64_t messages_;  // left, as the next one
  std::uint64_t plain_;
};

// The first `declared` bytes of a stream that is inflated, which outlives this, as the budget is.
class BudgetedBytes final : public ByteStream {
 public:
  BudgetedBytes(ByteStream& from, std::uint64_t declared, ReadBudget& budget,
                std::uint64_t weight = 1)
      : from_(from), left_(declared), budget_(budget), weight_(weight) {}

  std::size_t read(char* to, std::size_t most) override {
    const std::size_t size =
        from_.read(to, static_cast<std::size_t>(std::min<std::uint64_t>(most, left_)));
    take(size);
    return size;
  }
  std::uint64_t skip(std::uint64_t count) override {
    std::uint64_t done = 0;
    count = std::min(count, left_);
    while (done < count) {
      const std::uint64_t size = from_.skip(std::min(count - done, kStep));
      if (size == 0) break;
      take(size);
      done += size;
    }
    return done;
  }
  // How many of the declared bytes were not read.
  std::uint64_t left() const { return left_; }
  // Whether there are more than were declared. Once, where none is left.
  bool has_more() {
    char next = 0;
    return from_.read(&next, 1) > 0;
  }

 private:
  static constexpr std::uint64_t kStep = std::uint64_t{1} << 20;

  void take(std::uint64_t size) {
    left_ -= size;
    budget_.take_plain(size, weight_);
  }

  ByteStream& from_;
  std::uint64_t left_;
  ReadBudget& budget_;
  std::uint64_t weight_;
};

}  // namespace simbench::bags
