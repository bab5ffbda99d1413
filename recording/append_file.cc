#include "recording/append_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "recording/recording_folder.h"

namespace simbench {

AppendFile::AppendFile(std::string path) : path_(std::move(path)) {
  file_ = open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail(errno);
}

AppendFile::~AppendFile() {
  try {
    if (!failed_) flush();
  } catch (const RecordingFolderError&) {  // there is no caller to report it to
  }
  if (file_ >= 0) ::close(file_);
}

void AppendFile::flush() {
  if (failed_) fail(EIO);
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = write(file_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : ENOSPC);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AppendFile::close() {
  flush();
  const int file = std::exchange(file_, -1);
  if (file >= 0 && ::close(file) != 0 && errno != EINTR) fail(errno);
}

void AppendFile::fail(int reason) {
  failed_ = true;
  throw RecordingFolderError(
      fmt::format("{}: cannot be written: {}", path_, std::strerror(reason)));
}

}  // namespace simbench
