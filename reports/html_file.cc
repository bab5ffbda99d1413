#include "reports/html_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "reports/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& named, const std::string& problem) {
  throw OutputError(fmt::format("--output {}: {}", named, problem));
}

// Of the last call that failed; a stream keeps no reason of its own.
std::string system_reason() { return errno ? std::strerror(errno) : "write error"; }

// The full path; where a link stands, of what it leads to.
fs::path full_path(const std::string& named) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(named), error);
  if (error) fail(named, error.message());
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(named, "is a folder; name a file, such as report.html");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail(named, "is no file that can be replaced; name another one");
  }
  if (!fs::is_directory(path.parent_path(), error)) {
    fail(named, fmt::format("there is no folder {}; make it first", path.parent_path().string()));
  }
  return path;
}

}  // namespace

HtmlFile::HtmlFile(const std::string& path) : named_(path), path_(full_path(path)) {
  temporary_ =
      path_.parent_path() / fmt::format(".{}.{}.unfinished", path_.filename().string(), getpid());
  errno = 0;
  std::ofstream file(temporary_, std::ios::binary);
  if (!file) {
    fail(named_, fmt::format("cannot be written: {}; name another place", system_reason()));
  }
}

HtmlFile::~HtmlFile() {
  std::error_code ignored;  // nothing more can be done about it
  fs::remove(temporary_, ignored);
}

void HtmlFile::write(std::string_view html) {
  errno = 0;
  std::ofstream file(temporary_, std::ios::binary);
  file.write(html.data(), static_cast<std::streamsize>(html.size()));
  file.close();
  if (!file) {
    fail(named_, fmt::format("cannot be written: {}; nothing was kept", system_reason()));
  }
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(named_, fmt::format("cannot be written: {}", error.message()));
}

}  // namespace simbench::reports
