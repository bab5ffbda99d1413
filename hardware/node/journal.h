// The journal of a session: a node's recording, as a file that outlives the node.
//
// One file a session, `<session>.csv` in the journal folder: lines of recording/event_text.h, and
// "note,TEXT" lines for the user (texts escaped as in event_text.h). A batch of lines goes to the
// kernel by one write(), at most kJournalBatch after its first line, so that a killed node loses no
// more than that, and nothing in the middle.
//
// A write that fails (a full disk) ends the file at its last whole line. The trouble is reported
// once, and later frames are counted, not kept. The session goes on.
//
// The folder is readable by its owner alone (0700) and keeps the newest kKeptJournals files; a new
// file displaces the oldest. Files with other names are not touched.
//
// One thread, the one that runs `context`. Errors: JournalError from the constructor if the folder
// or the file cannot be made; one line with the path.
//
//   Journal journal(context, folder, "0123456789abcdef", [&](const std::string& text) { ... });
//   journal.write(FrameEvent{record, std::nullopt});
//   journal.note("camera 018322071234: unplugged");
//   std::optional<JournalChunk> chunk = read_journal(folder, "0123456789abcdef", 0);
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hardware/descriptor.h"
#include "recording/event.h"

namespace simbench::hardware {

inline constexpr Nanoseconds kJournalBatch = std::chrono::milliseconds(20);
inline constexpr std::size_t kKeptJournals = 100;

class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Makes the folder if it is missing. Throws JournalError unless files can be made in it.
void make_journal_folder(const std::string& folder);

class Journal {
 public:
  using Trouble = std::function<void(const std::string& text)>;

  Journal(boost::asio::io_context& context, const std::string& folder, const std::string& session,
          Trouble trouble);
  ~Journal();  // closes it
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void write(const KeptEvent& event);
  // Bytes that are no UTF-8 are replaced.
  void note(const std::string& text);
  // Writes the waiting batch now.
  void flush();
  void close();

  std::uint64_t frames() const { return frames_; }
  // Frames lost since a write failed.
  std::uint64_t frames_not_kept() const { return frames_not_kept_; }

 private:
  void end_line();  // of the batch
  void fail(int error, std::size_t kept, std::string_view batch);

  std::string path_;
  Trouble trouble_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // for an expired timer
  Descriptor file_;
  bool failed_ = false;
  bool armed_ = false;
  std::string batch_;
  std::uint64_t size_ = 0;  // of what is on disk
  std::uint64_t frames_ = 0;
  std::uint64_t frames_not_kept_ = 0;
};

// Part of a journal, whole lines only, even if the node was killed in a write.
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
