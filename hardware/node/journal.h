// The journal of a session: what a node recorded, as a file that outlives the node.
//
// One file a session, `<session>.csv` in the journal folder: lines of recording/event_text.h, and
// "note,TEXT" lines for what a user should know (texts escaped as event_text.h does). Lines are
// gathered and handed to the kernel by one write() a batch, at most kJournalBatch after the first
// of them, so that a node that is killed loses no more than that, and nothing in the middle.
//
// A write that fails (a full disk) ends the file at its last whole line: the trouble is told once,
// and what comes later is counted, not kept. Nothing else stops for it.
//
// The folder is its owner's alone (0700) and keeps the newest kKeptJournals files; older ones go
// when a new one is made. Files with other names are not touched.
//
// One thread, the one that runs `context`. Errors: JournalError from the constructor: the folder or
// the file cannot be made; one line with the path.
//
//   Journal journal(context, folder, "0123456789abcdef", [&](const std::string& text) { ... });
//   journal.write(FrameEvent{record, std::nullopt});
//   journal.note("camera 018322071234: unplugged");
//   std::optional<JournalChunk> chunk = read_journal(folder, "0123456789abcdef", 0);
#ifndef SIMBENCH_HARDWARE_NODE_JOURNAL_H_
#define SIMBENCH_HARDWARE_NODE_JOURNAL_H_

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "recording/event.h"

namespace simbench::hardware {

inline constexpr Nanoseconds kJournalBatch = std::chrono::milliseconds(20);
inline constexpr std::size_t kKeptJournals = 100;

class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Makes the folder if it is not there, and finds out whether files can be made in it.
void make_journal_folder(const std::string& folder);

class Journal {
 public:
  using Trouble = std::function<void(const std::string& text)>;

  Journal(boost::asio::io_context& context, const std::string& folder, const std::string& session,
          Trouble trouble);
  ~Journal();  // closes it
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void write(const RecordingEvent& event);
  // Bytes that are no UTF-8 are replaced.
  void note(const std::string& text);
  // Hands over what waits, now.
  void flush();
  void close();

  std::uint64_t frames() const { return frames_; }
  // Frames that were not kept because a write had failed.
  std::uint64_t frames_not_kept() const { return frames_not_kept_; }

 private:
  void append(const std::string& line);
  void fail(int error, std::size_t kept, std::string_view batch);

  std::string path_;
  Trouble trouble_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // for a timer that has gone off
  int file_ = -1;
  bool failed_ = false;
  bool armed_ = false;
  std::string batch_;
  std::uint64_t size_ = 0;  // of what is on disk
  std::uint64_t frames_ = 0;
  std::uint64_t frames_not_kept_ = 0;
};

// Part of a journal, whole lines only (also of one whose node was killed in a write).
struct JournalChunk {
  std::string text;        // from `offset`, at most kJournalChunkBytes (protocol.h)
  std::uint64_t size = 0;  // of the whole lines there are now
};

// Nothing if there is no such journal. Throws JournalError if it cannot be read, or if `offset` is
// beyond its end.
std::optional<JournalChunk> read_journal(const std::string& folder, const std::string& session,
                                         std::uint64_t offset);

// A line of a journal as the text of a note; nothing if it is another kind of line.
std::optional<std::string> note_of_line(std::string_view line);
std::string note_line(std::string_view text);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_JOURNAL_H_
