#include "reports/figures/file_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "reports/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& problem) {
  throw OutputError(fmt::format("{}: {}", file.string(), problem));
}

}  // namespace

FileOutput::FileOutput(fs::path file) : file_(std::move(file)) {
  std::error_code error;
  if (!file_.has_filename()) fail(file_, "is a folder; name a file");
  if (fs::is_directory(file_, error)) fail(file_, "is a folder; name a file in it");
  const fs::path folder = file_.has_parent_path() ? file_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    fail(file_, fmt::format("there is no folder {}; make it first", folder.string()));
  }
  temporary_ = folder / fmt::format(".{}.{}.unfinished", file_.filename().string(), getpid());
}

FileOutput::~FileOutput() {
  std::error_code ignored;  // there may be none
  fs::remove(temporary_, ignored);
}

void FileOutput::write(const std::string& content) const {
  errno = 0;
  std::ofstream out(temporary_, std::ios::binary);
  out << content;
  out.close();
  if (!out) fail(file_, errno != 0 ? std::strerror(errno) : "write error");
}

void FileOutput::publish() const {
  std::error_code error;
  fs::rename(temporary_, file_, error);
  if (error) fail(file_, error.message());
}

}  // namespace simbench::reports
