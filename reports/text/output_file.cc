#include "reports/text/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "reports/text/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& named, const std::string& problem) {
  throw OutputError(fmt::format("{}: {}", named, problem));
}

// Of the last call that failed; a stream keeps no reason of its own.
// The full path; where a link stands, of what it leads to.
fs::path full_path(const std::string& named) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(named), error);
  if (error) fail(named, error.message());
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(named, "is a folder; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail(named, "is no file that can be replaced; name another one");
  }
  if (!fs::is_directory(path.parent_path(), error)) {
    const fs::path folder = fs::path(named).parent_path();
    fail(named, fmt::format("there is no folder {}; make it first", folder.string()));
  }
  return path;
}

}  // namespace

std::string system_reason() { return errno ? std::strerror(errno) : "write error"; }

OutputFile::OutputFile(const std::string& path) : named_(path), path_(full_path(path)) {
  temporary_ =
      path_.parent_path() / fmt::format(".{}.{}.unfinished", path_.filename().string(), getpid());
  errno = 0;
  std::ofstream file(temporary_, std::ios::binary);
  if (!file) {
    fail(named_, fmt::format("cannot be written: {}; name another place", system_reason()));
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;  // nothing more can be done about it
  fs::remove(temporary_, ignored);
}

void OutputFile::write(std::string_view content) const {
  errno = 0;
  std::ofstream file(temporary_, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    fail(named_, fmt::format("cannot be written: {}; nothing was kept", system_reason()));
  }
}

void OutputFile::publish() const {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(named_, fmt::format("cannot be written: {}", error.message()));
}

void write_file(const std::string& path, std::string_view content) {
  const OutputFile file(path);
  file.write(content);
  file.publish();
}

}  // namespace simbench::reports
