#include "recording/distrusted_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>

namespace simbench {
namespace {

// Folders below it are moved up before they are emptied.
constexpr int kDeepestInPlace = 32;

class TreeRemover {
 public:
  explicit TreeRemover(int top) : top_(top) {}

  // Goes through the folder until there is nothing left that it can remove.
  void empty(int folder, int depth) {
    DIR* entries = fdopendir(dup(folder));
    if (entries == nullptr) return;
    for (bool has_removed = true; has_removed;) {
      has_removed = false;
      rewinddir(entries);
      while (const dirent* entry = readdir(entries)) {
        const std::string_view name = entry->d_name;
        if (name == "." || name == "..") continue;
        has_removed |= remove(folder, entry->d_name, depth);
      }
    }
    closedir(entries);
  }

 private:
  bool remove(int folder, const char* name, int depth) {
    if (unlinkat(folder, name, 0) == 0) return true;
    const int child = open_folder_in(folder, name);
    if (child < 0) return false;
    if (depth >= kDeepestInPlace && move_up(folder, name)) {
      close(child);
      return true;
    }
    empty(child, depth + 1);
    close(child);
    return unlinkat(folder, name, AT_REMOVEDIR) == 0;
  }

  bool move_up(int folder, const char* name) {
    constexpr int kTries = 1000;  // its own names may be among them
    for (int i = 0; i < kTries; ++i) {
      const std::string place = "deep" + std::to_string(moved_++);
      if (renameat(folder, name, top_, place.c_str()) == 0) return true;
      if (errno != EEXIST && errno != ENOTEMPTY && errno != ENOTDIR) return false;
    }
    return false;
  }

  int top_;
  unsigned long moved_ = 0;
};

}  // namespace

int open_folder_in(int parent, const char* name) {
  const int place = openat(parent, name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (place < 0) return -1;
  struct stat status {};
  if (fstat(place, &status) == 0 && (status.st_mode & S_IRWXU) != S_IRWXU) {
    // By the descriptor: another folder may have the name by now.
    const std::string own_name = "/proc/self/fd/" + std::to_string(place);
    chmod(own_name.c_str(), (status.st_mode & 07777U) | S_IRWXU);
  }
  const int folder = openat(place, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const int error = errno;
  close(place);
  errno = error;
  return folder;
}

bool remove_tree(const std::filesystem::path& path) {
  if (unlink(path.c_str()) == 0 || errno == ENOENT) return true;
  const int folder = open_folder_in(AT_FDCWD, path.c_str());
  if (folder < 0) return false;
  TreeRemover(folder).empty(folder, 0);
  close(folder);
  return rmdir(path.c_str()) == 0;
}

}  // namespace simbench
