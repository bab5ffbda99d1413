// A file that is only written to at its end, through a buffer, straight to the
// kernel: what flush() has written outlives the process. Otherwise it flushes only at destruction,
// where errors are dropped.
//
// Errors: RecordingFolderError with the file and the reason (a full disk). After one, the file
// takes nothing more: a line that was cut stays the last.
//
//   AppendFile file("DIR/frames.csv");   // must not be there yet
//   file.buffer() += "a line\n";
//   file.flush();
#pragma once

#include <string>

namespace simbench {

class AppendFile {
 public:
  explicit AppendFile(std::string path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  std::string& buffer() { return buffer_; }
  void flush();
  // Flushes, and reports what only closing reveals.
  void close();

 private:
  [[noreturn]] void fail(int reason);

  std::string path_;
  std::string buffer_;
  int file_ = -1;
  bool failed_ = false;
};

}  // namespace simbench
