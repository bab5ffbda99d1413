#include "reports/text/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& named, const std::string& problem) {
  throw OutputError(fmt::format("{}: {}", named, problem));
}

// The full path, for a link that of its target.
fs::path full_path(const std::string& named) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(named), error);
  if (error) fail(named, error.message());
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(named, "is a folder; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail(named, "is not a file that can be replaced; name another one");
  }
  if (!fs::is_directory(path.parent_path(), error)) {
    const fs::path folder = fs::path(named).parent_path();
    fail(named, fmt::format("there is no folder {}; make it first", folder.string()));
  }
  return path;
}

constexpr std::array<const char*, 4> kOwnFiles = {kManifest, "results.json", "frames.csv",
                                                  "hosts.csv"};

// The folder's full path, without a slash at its end, for the name of a sibling.
fs::path normal_path(const fs::path& folder) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) fail_output(folder, error.message());
  if (!path.has_filename()) path = path.parent_path();
  if (!path.has_relative_path()) fail_output(folder, "is the root folder; name a folder in it");
  return path;
}

bool is_own_file(const fs::path& name, const std::vector<std::string>& more_own_files) {
  const auto is_name = [&](const std::string& own) { return name == own; };
  return std::any_of(kOwnFiles.begin(), kOwnFiles.end(), is_name) ||
         std::any_of(more_own_files.begin(), more_own_files.end(), is_name);
}

// Refuses an existing folder unless it is empty or holds an earlier result and nothing else.
void check_replaceable(const fs::path& folder, const std::vector<std::string>& more_own_files) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) fail_output(folder, "is a file; name a folder");
  bool empty = true;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    empty = false;
    const fs::path name = entry->path().filename();
    if (!is_own_file(name, more_own_files)) {
      fail_output(folder,
                  fmt::format("holds other files ({}); name a new folder or an earlier result",
                              name.string()));
    }
  }
  if (error) fail_output(folder, error.message());
  if (!empty && !fs::exists(folder / kManifest, error)) {
    fail_output(
        folder,
        "is neither empty nor an earlier result (it has no manifest.json); name a new folder");
  }
}

}  // namespace

void fail_output(const fs::path& folder, const std::string& problem) {
  throw OutputError(fmt::format("--output {}: {}", folder.string(), problem));
}

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
  std::error_code ignored;
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

OutputFolder::OutputFolder(const fs::path& folder, const std::vector<std::string>& more_own_files)
    : folder_(normal_path(folder)) {
  check_replaceable(folder_, more_own_files);
  const fs::path parent = folder_.parent_path();
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    fail_output(folder, fmt::format("there is no folder {}; make it first", parent.string()));
  }
  temporary_ = parent / fmt::format(".{}.{}.unfinished", folder_.filename().string(), getpid());
  fs::remove_all(temporary_, error);  // of an earlier process with this one's number
  fs::create_directory(temporary_, error);
  if (error) fail_output(folder, fmt::format("cannot be written: {}", error.message()));
}

OutputFolder::~OutputFolder() {
  open_.close();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

std::ostream& OutputFolder::file(const std::string& name) {
  finish_file();
  open_name_ = temporary_ / name;
  open_.open(open_name_, std::ios::binary);
  if (!open_) fail_output(folder_, fmt::format("cannot write {}: {}", name, system_reason()));
  return open_;
}

void OutputFolder::finish_file() {
  if (!open_.is_open()) return;
  open_.close();
  if (!open_) {
    fail_output(folder_, fmt::format("cannot write {}: {}; nothing was kept",
                                     open_name_.filename().string(), system_reason()));
  }
}

void OutputFolder::publish() {
  finish_file();
  std::error_code error;
  fs::path aside;
  if (fs::exists(folder_, error)) {
    aside = temporary_;
    aside += ".old";
    fs::rename(folder_, aside, error);
    if (error) fail_output(folder_, fmt::format("cannot be replaced: {}", error.message()));
  }
  fs::rename(temporary_, folder_, error);
  if (error) {
    std::error_code ignored;
    if (!aside.empty()) fs::rename(aside, folder_, ignored);
    fail_output(folder_, fmt::format("cannot be written: {}", error.message()));
  }
  temporary_.clear();
  if (!aside.empty()) fs::remove_all(aside, error);
}

}  // namespace simbench::reports
