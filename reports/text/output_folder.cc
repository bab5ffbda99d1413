#include "reports/text/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "reports/text/output_file.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";
constexpr std::array<const char*, 4> kOwnFiles = {kManifest, "results.json", "frames.csv",
                                                  "hosts.csv"};

[[noreturn]] void fail(const fs::path& folder, const std::string& problem) {
  throw OutputError(fmt::format("--output {}: {}", folder.string(), problem));
}

// Of the last call that failed; a stream keeps no reason of its own.
// The folder's full path, without a slash at its end: it gets a sibling.
fs::path normal_path(const fs::path& folder) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) fail(folder, error.message());
  if (!path.has_filename()) path = path.parent_path();
  if (!path.has_relative_path()) fail(folder, "is the root folder; name a folder in it");
  return path;
}

bool is_own_file(const fs::path& name, const std::vector<std::string>& more_own_files) {
  const auto is_name = [&](const std::string& own) { return name == own; };
  return std::any_of(kOwnFiles.begin(), kOwnFiles.end(), is_name) ||
         std::any_of(more_own_files.begin(), more_own_files.end(), is_name);
}

// An existing folder may be replaced if it is empty or holds an earlier result and nothing else.
void check_replaceable(const fs::path& folder, const std::vector<std::string>& more_own_files) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) fail(folder, "is a file; name a folder");
  bool empty = true;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    empty = false;
    const fs::path name = entry->path().filename();
    if (!is_own_file(name, more_own_files)) {
      fail(folder, fmt::format("holds other files ({}); name a new folder or an earlier result",
                               name.string()));
    }
  }
  if (error) fail(folder, error.message());
  if (!empty && !fs::exists(folder / kManifest, error)) {
    fail(folder, "is not empty and no earlier result (it has no manifest.json); name a new folder");
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, const std::vector<std::string>& more_own_files)
    : folder_(normal_path(folder)) {
  check_replaceable(folder_, more_own_files);
  const fs::path parent = folder_.parent_path();
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    fail(folder, fmt::format("there is no folder {}; make it first", parent.string()));
  }
  temporary_ = parent / fmt::format(".{}.{}.unfinished", folder_.filename().string(), getpid());
  fs::remove_all(temporary_, error);  // of a process that had this one's number
  fs::create_directory(temporary_, error);
  if (error) fail(folder, fmt::format("cannot be written: {}", error.message()));
}

OutputFolder::~OutputFolder() {
  open_.close();
  std::error_code ignored;  // nothing more can be done about it
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

std::ostream& OutputFolder::file(const std::string& name) {
  finish_file();
  open_name_ = temporary_ / name;
  open_.open(open_name_, std::ios::binary);
  if (!open_) fail(folder_, fmt::format("cannot write {}: {}", name, system_reason()));
  return open_;
}

void OutputFolder::finish_file() {
  if (!open_.is_open()) return;
  open_.close();
  if (!open_) {
    fail(folder_, fmt::format("cannot write {}: {}; nothing was kept",
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
    if (error) fail(folder_, fmt::format("cannot be replaced: {}", error.message()));
  }
  fs::rename(temporary_, folder_, error);
  if (error) {
    std::error_code ignored;
    if (!aside.empty()) fs::rename(aside, folder_, ignored);
    fail(folder_, fmt::format("cannot be written: {}", error.message()));
  }
  temporary_.clear();
  if (!aside.empty()) fs::remove_all(aside, error);
}

}  // namespace simbench::reports
