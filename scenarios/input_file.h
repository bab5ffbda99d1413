// Reads the files that a user names. Each read is checked: an error is an error, never the end of
// the file.
//
// Folders, devices and sockets are refused; a device may have no end. A pipe is read until its
// writers close it, or refused where only a file is of use (Pipes::kRefused): a recording is read
// from several places, and a pipe without a writer would be waited for without a word. Whole files
// have a limit, which also ends a pipe that never ends.
//
// Errors: FileError; its what() is the reason alone ("Input/output error"), for a message that
// names the file.
//
//   char buffer[4096];
//   InputFile file("front.csv");
//   while (const std::size_t size = file.read(buffer, sizeof buffer)) use(buffer, size);
//
//   const std::string text = file_content("scenario.json", 4 << 20);
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace simbench {

class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class FileTooLarge : public FileError {
 public:
  using FileError::FileError;
};

enum class Pipes : std::uint8_t { kRead, kRefused };

class InputFile {
 public:
  explicit InputFile(const std::string& path, Pipes pipes = Pipes::kRead);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Returns the number of bytes read, 1 to `most`; 0 only at the end. A signal that has a handler
  // ends the wait for a pipe with a FileError.
  std::size_t read(char* to, std::size_t most);
  // The next read() is of the bytes from `position` on. A pipe has no positions: FileError.
  void seek(std::uint64_t position);
  // Its size when it was opened; 0 if that is unknown (a pipe).
  std::uint64_t size() const { return size_; }

 private:
  int file_ = -1;
  std::uint64_t size_ = 0;
  bool waits_ = false;  // a pipe
};

// The whole content. Throws FileTooLarge, a FileError, for more than `most` bytes.
std::string file_content(const std::string& path, std::size_t most, Pipes pipes = Pipes::kRead);

// For tests of read errors: replaces the system's read() and returns the one before.
using ReadFunction = ssize_t (*)(int file, void* to, std::size_t most);
ReadFunction exchange_read_function(ReadFunction other);

}  // namespace simbench
