// Walks over trees of files, which libc's own do past stat() and readdir(): in order, with what
// these say.
//
// Source: nftw(3).
#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

using Visit = int (*)(const char*, const struct stat*, int, struct FTW*);

struct Walk {
  Visit visit;
  int flags;
  dev_t device;
};

// What nftw() calls it.
int kind_at(const char* path, int flags, struct stat& status) {
  const bool follows = (flags & FTW_PHYS) == 0;
  const int found = follows ? stat(path, &status) : lstat(path, &status);
  if (found < 0) return follows && lstat(path, &status) == 0 ? FTW_SLN : FTW_NS;
  if (S_ISDIR(status.st_mode)) return FTW_D;
  return S_ISLNK(status.st_mode) ? FTW_SL : FTW_F;
}

int base_of(const char* path) {
  const char* slash = strrchr(path, '/');
  return slash != nullptr && slash[1] != '\0' ? static_cast<int>(slash - path) + 1 : 0;
}

// How the walk goes on after a visit.
struct Visited {
  int result = 0;  // other than 0: that of the walk
  bool skips = false;
  bool goes_up = false;
};

Visited visited_of(const Walk& walk, int answered) {
  if ((walk.flags & FTW_ACTIONRETVAL) == 0) return {.result = answered};
  if (answered == FTW_SKIP_SUBTREE) return {.skips = true};
  if (answered == FTW_SKIP_SIBLINGS) return {.goes_up = true};
  return {.result = answered == FTW_CONTINUE ? 0 : answered};
}

Visited visit_at(const Walk& walk, char* path, int level);

Visited visit_within(const Walk& walk, char* path, DIR* folder, int level) {
  const std::size_t size = strlen(path);
  const char* between = size > 0 && path[size - 1] == '/' ? "" : "/";
  while (const dirent* entry = readdir(folder)) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    const int more = snprintf(path + size, PATH_MAX - size, "%s%s", between, entry->d_name);
    if (static_cast<std::size_t>(more) >= PATH_MAX - size) {
      path[size] = '\0';
      errno = ENAMETOOLONG;
      return {.result = -1};
    }
    const Visited done = visit_at(walk, path, level + 1);
    path[size] = '\0';
    if (done.result != 0) return done;
    if (done.goes_up) break;
  }
  return {};
}

Visited visit_at(const Walk& walk, char* path, int level) {
  struct stat status {};
  int kind = kind_at(path, walk.flags, status);
  FTW place{.base = base_of(path), .level = level};
  if ((walk.flags & FTW_MOUNT) != 0 && level > 0 && status.st_dev != walk.device) return {};
  const bool is_after = (walk.flags & FTW_DEPTH) != 0;
  DIR* folder = kind == FTW_D ? opendir(path) : nullptr;
  if (kind == FTW_D && folder == nullptr) kind = FTW_DNR;
  Visited done;
  if (folder == nullptr || !is_after) {
    done = visited_of(walk, walk.visit(path, &status, kind, &place));
  }
  if (folder == nullptr) return done;
  if (done.result == 0 && !done.skips && !done.goes_up) {
    done = visit_within(walk, path, folder, level);
  }
  closedir(folder);
  if (done.result == 0 && is_after) {
    done = visited_of(walk, walk.visit(path, &status, FTW_DP, &place));
  }
  return done;
}

}  // namespace

SIMBENCH_CALL int nftw(const char* path, Visit visit, int most, int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(nftw)(path, visit, most, flags);
  if ((flags & FTW_CHDIR) != 0) give_up("nftw() with FTW_CHDIR");
  char room[PATH_MAX];
  if (strlen(path) >= sizeof room) return refuse(ENAMETOOLONG);
  strcpy(room, path);
  struct stat status {};
  if (lstat(path, &status) < 0) return -1;
  return visit_at({.visit = visit, .flags = flags, .device = status.st_dev}, room, 0).result;
}

SIMBENCH_CALL int nftw64(const char*, int (*)(const char*, const struct stat64*, int, struct FTW*),
                         int, int) __attribute__((alias("nftw")));

}  // namespace simbench::shim
