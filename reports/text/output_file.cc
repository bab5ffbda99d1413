#include "reports/text/output_file.h"

#include <fmt/format.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

#include "algorithms/ports/assert.h"
#include "recording/file_kind.h"
#include "recording/number_in.h"
#include "scenarios/document.h"
#include "scenarios/input_file.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

// The ending of an earlier result's name while the next one gets that.
constexpr const char* kAside = ".old";

thread_local int held_interrupts = 0;
void change_interrupt_mask(int how) {
  sigset_t interruptions;
  sigemptyset(&interruptions);
  for (const int number : {SIGINT, SIGTERM}) sigaddset(&interruptions, number);
  pthread_sigmask(how, &interruptions, nullptr);
}

[[noreturn]] void fail(const std::string& named, const std::string& problem) {
  throw OutputError(fmt::format("{}: {}", named, problem));
}

// Nothing can be written there until somebody has made the target.
void refuse_dangling_link(const std::string& named, const fs::path& path) {
  fs::path link = fs::absolute(path);
  if (!link.has_filename()) link = link.parent_path();
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(link, error)) || fs::exists(link, error)) return;
  fail(named, fmt::format("is a link to {}, which does not exist; make that, or remove the link",
                          fs::read_symlink(link, error).string()));
}

// The name under which this process, or another one, writes `path`.
fs::path unfinished_path(const fs::path& path, const std::string& process) {
  return path.parent_path() / fmt::format(".{}.{}.unfinished", path.filename().string(), process);
}

bool is_dead(const std::string& process) {
  const std::optional<pid_t> id = number_in<pid_t>(process);
  return id && *id > 0 && ::kill(*id, 0) != 0 && errno == ESRCH;
}

// Removes what killed processes have left of `path`. An earlier result that such a one had put
// aside to replace it gets its name back.
void clear_unfinished(const fs::path& path) {
  const std::string begin = fmt::format(".{}.", path.filename().string());
  const std::string end = ".unfinished";
  std::vector<std::string> dead;
  std::error_code error;
  for (fs::directory_iterator entry(path.parent_path(), error), last; !error && entry != last;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= begin.size() + end.size()) continue;
    if (!name.starts_with(begin) || !name.ends_with(end)) continue;
    const std::string process = name.substr(begin.size(), name.size() - begin.size() - end.size());
    if (is_dead(process)) dead.push_back(process);
  }
  for (const std::string& process : dead) {
    const fs::path unfinished = unfinished_path(path, process);
    fs::path aside = unfinished;
    aside += kAside;
    if (!fs::exists(path, error)) fs::rename(aside, path, error);
    fs::remove_all(aside, error);
    fs::remove_all(unfinished, error);
  }
}

constexpr std::array<const char*, 4> kOwnFiles = {kManifest, "results.json", "frames.csv",
                                                  "hosts.csv"};

// Whether the file is of an archive of results or of a recording folder.
bool is_part_of_results(const fs::path& path) {
  const std::string name = path.filename().string();
  const fs::path folder = path.parent_path();
  std::error_code none;
  if (name == "events.csv") return lasting_kind(folder / "frames.csv").has_value();
  return std::ranges::find(kOwnFiles, name) != kOwnFiles.end() &&
         fs::exists(folder / kManifest, none) && fs::exists(path, none);
}

// The full path, for a link that of its target.
fs::path full_path(const std::string& named) {
  refuse_dangling_link(named, named);
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(named), error);
  if (error) fail(named, error.message());
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(named, "is a folder; name a file in it");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail(named, "is not a file that can be replaced; name another one");
  }
  if (const auto why = irreplaceable(path)) fail(named, *why + "; name another file");
  if (!fs::is_directory(path.parent_path(), error)) {
    const fs::path folder = fs::path(named).parent_path();
    fail(named, fmt::format("there is no folder {}; make it first", folder.string()));
  }
  return path;
}

// The folder's full path, without a slash at its end, for the name of a sibling.
fs::path normal_path(const fs::path& folder) {
  refuse_dangling_link(fmt::format("--output {}", folder.string()), folder);
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

std::optional<std::string> irreplaceable(const fs::path& path) {
  if (const auto kind = lasting_kind(path)) return fmt::format("is {}", *kind);
  if (is_part_of_results(path)) return fmt::format("is a part of {}", path.parent_path().string());
  return std::nullopt;
}

void fail_output(const fs::path& folder, const std::string& problem) {
  throw OutputError(fmt::format("--output {}: {}", folder.string(), problem));
}

std::optional<std::string> content_of(const std::filesystem::path& path) {
  constexpr std::size_t kLargest = std::size_t{512} << 20;
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return std::nullopt;
  try {
    return file_content(path.string(), kLargest);
  } catch (const FileError& error) {
    scenarios::fail_to_read(scenarios::shown_text(path.string()), error.what());
  }
}

std::string system_reason() { return errno ? std::strerror(errno) : "write error"; }

HeldInterrupt::HeldInterrupt() {
  if (held_interrupts++ == 0) change_interrupt_mask(SIG_BLOCK);
}
HeldInterrupt::~HeldInterrupt() {
  if (--held_interrupts == 0) change_interrupt_mask(SIG_UNBLOCK);
}

OutputFile::OutputFile(const std::string& path)
    : named_(path), path_(full_path(path)), temporary_([&] {
        clear_unfinished(path_);
        fs::path temporary = unfinished_path(path_, std::to_string(getpid()));
        errno = 0;
        std::ofstream file(temporary, std::ios::binary);
        if (!file) {
          fail(named_, fmt::format("cannot be written: {}; name another place", system_reason()));
        }
        return temporary;
      }) {}

void OutputFile::write(std::string_view content) const {
  errno = 0;
  std::ofstream file;
  temporary_.change([&] { file.open(temporary_.path(), std::ios::binary); });
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    fail(named_, fmt::format("cannot be written: {}; nothing was kept", system_reason()));
  }
}

void OutputFile::publish() {
  temporary_.keep([&] {
    std::error_code error;
    fs::rename(temporary_.path(), path_, error);
    if (error) fail(named_, fmt::format("cannot be written: {}", error.message()));
  });
}

void write_file(const std::string& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.publish();
}

OutputFolder::OutputFolder(const fs::path& folder, const std::vector<std::string>& more_own_files)
    : folder_(normal_path(folder)) {
  clear_unfinished(folder_);
  check_replaceable(folder_, more_own_files);
  const fs::path parent = folder_.parent_path();
  std::error_code error;
  if (!fs::is_directory(parent, error)) {
    fail_output(folder, fmt::format("there is no folder {}; make it first", parent.string()));
  }
  temporary_.emplace([&] {
    fs::path temporary = unfinished_path(folder_, std::to_string(getpid()));
    fs::remove_all(temporary, error);  // of an earlier process with this one's number
    fs::create_directory(temporary, error);
    if (error) fail_output(folder, fmt::format("cannot be written: {}", error.message()));
    return temporary;
  });
}

std::ostream& OutputFolder::file(const std::string& name) {
  finish_file();
  SIMBENCH_ASSERT(temporary_.has_value(), "a published folder gets no more files");
  open_name_ = temporary_->path() / name;
  temporary_->change([&] {
    std::error_code error;
    fs::create_directories(open_name_.parent_path(), error);
    open_.open(open_name_, std::ios::binary);
  });
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
  temporary_->keep([&] {
    if (fs::exists(folder_, error)) {
      aside = temporary_->path();
      aside += kAside;
      fs::rename(folder_, aside, error);
      if (error) fail_output(folder_, fmt::format("cannot be replaced: {}", error.message()));
    }
    fs::rename(temporary_->path(), folder_, error);
    if (error) {
      std::error_code ignored;
      if (!aside.empty()) fs::rename(aside, folder_, ignored);
      fail_output(folder_, fmt::format("cannot be written: {}", error.message()));
    }
    if (!aside.empty()) fs::remove_all(aside, error);
  });
  temporary_.reset();
}

}  // namespace simbench::reports
