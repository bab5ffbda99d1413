// A file that grows, read as it does.
//
// Problem: programs append to a log for weeks, while others rotate it, truncate it, or move it away
// and bring it back. A reader that holds the file reads a dead one; one that opens it anew each
// time reads all of it again, or loses its end.
//
// What is done: the file stays open and is read on. Where another file has come in its place, the
// rest of the old one is read first, then the new one from its beginning. Where it has become
// shorter, it is read from its beginning. Where it is not there, nothing is read until it comes
// back. Only whole lines are handed out; what follows the last line end waits for it.
//
// A file that is long already is not read from its beginning, but its last most_first bytes. A file
// that was truncated and has grown beyond the old length between two polls cannot be told from one
// that was appended to.
//
// Memory: a piece at most kMostPiece long, and the unfinished line.
//
//   Tail tail("/var/log/chrony/tracking.log");
//   for (;;) use(tail.poll().text);
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace simbench::watch {

inline constexpr std::size_t kMostPiece = 4 * 1024 * 1024;
inline constexpr std::size_t kLongestLine = 1024 * 1024;
inline constexpr std::uint64_t kMostFirst = 4 * 1024 * 1024;

struct GrownText {
  std::string text{};    // whole lines; empty: nothing new
  bool is_there = true;  // the file, by its name
  bool begins_anew =
      false;            // another file, or the same from its beginning: its heading comes first
  bool is_cut = false;  // what was skipped before the first line is not known
};

// Where a text that grows comes from: a file (Tail), or a program (pipe_text.h).
class GrowingText {
 public:
  virtual ~GrowingText() = default;
  virtual const std::string& path() const = 0;
  // What has come since the last call; what cannot be read is not there.
  virtual GrownText poll() = 0;
  // The first bytes of the text that is read, at most so many: where its heading is.
  virtual std::string head(std::size_t most) const = 0;
};

class Tail final : public GrowingText {
 public:
  explicit Tail(std::string path, std::uint64_t most_first = kMostFirst);
  ~Tail() override;
  Tail(const Tail&) = delete;
  Tail& operator=(const Tail&) = delete;

  const std::string& path() const override { return path_; }
  GrownText poll() override;
  std::string head(std::size_t most) const override;

 private:
  bool open();
  void close();
  // Whether another file stands under the name, or none.
  bool is_replaced(bool& is_there) const;
  std::string read_on();

  std::string path_;
  std::uint64_t most_first_;
  int file_ = -1;
  dev_t device_ = 0;
  ino_t number_ = 0;
  std::uint64_t at_ = 0;
  std::string unfinished_;
  bool was_opened_ = false;  // ever
  bool skips_line_ = false;  // the first line was begun before
};

}  // namespace simbench::watch
