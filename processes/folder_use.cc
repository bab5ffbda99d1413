#include "processes/folder_use.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "recording/distrusted_folder.h"

namespace simbench::processes {
namespace {

bool is_exceeded(const FolderUse& use, const FolderLimits& limits) {
  return use.bytes > limits.bytes || use.files > limits.files || use.depth > limits.depth;
}

class FolderCount {
 public:
  explicit FolderCount(const FolderLimits& limits) : limits_(limits) {}

  void add(int folder, std::size_t depth) {
    DIR* entries = fdopendir(folder);
    if (entries == nullptr) {
      close(folder);
      return;
    }
    while (const dirent* entry = readdir(entries)) {
      const std::string_view name = entry->d_name;
      if (name == "." || name == "..") continue;
      add_entry(folder, entry->d_name, depth);
      if (is_exceeded(use_, limits_)) break;
    }
    closedir(entries);
  }
  const FolderUse& use() const { return use_; }

 private:
  void add_entry(int folder, const char* name, std::size_t depth) {
    struct stat status {};
    if (fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) != 0) return;
    ++use_.files;
    use_.depth = std::max(use_.depth, depth);
    if (S_ISDIR(status.st_mode)) {
      if (is_exceeded(use_, limits_)) return;
      if (const int child = open_folder_in(folder, name); child >= 0) add(child, depth + 1);
      return;
    }
    if (status.st_nlink > 1 && !counted_.insert(status.st_ino).second) return;
    use_.bytes += bytes_of_file(status);
  }

  const FolderLimits& limits_;
  FolderUse use_;
  std::set<ino_t> counted_;
};

}  // namespace

std::uint64_t bytes_of_file(const struct stat& status) {
  constexpr std::uint64_t kBlock = 512;
  return std::max(static_cast<std::uint64_t>(status.st_size),
                  static_cast<std::uint64_t>(status.st_blocks) * kBlock);
}

FolderUse folder_use(int folder, const FolderLimits& limits) {
  FolderCount count(limits);
  // A description of its own: the one of `folder` has a place in it, which readdir() moves.
  if (const int own = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC); own >= 0) {
    count.add(own, 1);
  }
  return count.use();
}

std::string excess_of(const FolderUse& use, const FolderLimits& limits) {
  if (use.files > limits.files) return fmt::format("made more than {} files", limits.files);
  if (use.depth > limits.depth) {
    return fmt::format("made folders more than {} deep", limits.depth);
  }
  if (use.bytes > limits.bytes) {
    return fmt::format("wrote more than {} MiB into its folder", limits.bytes >> 20U);
  }
  return "";
}

}  // namespace simbench::processes
