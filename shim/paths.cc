#include "shim/paths.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

char folder[PATH_MAX];

// What is the host's own.
constexpr const char* kOwn[] = {"/run", "/var", "/tmp", "/dev/shm"};

bool is_below(const char* path, const char* above) {
  const std::size_t size = strlen(above);
  return strncmp(path, above, size) == 0 && (path[size] == '/' || path[size] == '\0');
}

bool is_own(const char* path) {
  for (const char* each : kOwn) {
    if (is_below(path, each)) return true;
  }
  return false;
}

// The folders that lead to it, within the host's folder.
void make_folders(char* path) {
  const int before = errno;
  const long mask = machine_call(SYS_umask, 0);
  for (char* slash = path + strlen(folder) + 1; (slash = strchr(slash, '/')) != nullptr; ++slash) {
    *slash = '\0';
    machine_call(SYS_mkdirat, AT_FDCWD, path, 0755);
    *slash = '/';
  }
  machine_call(SYS_umask, mask);
  errno = before;
}

// Folders of the machine's stay what they are, whatever files are given in their place.
bool is_there(const char* path, bool may_be_folder) {
  const int before = errno;
  struct stat status {};
  const bool found =
      machine_call(SYS_newfstatat, AT_FDCWD, path, &status, AT_SYMLINK_NOFOLLOW) == 0;
  errno = before;
  return found && (may_be_folder || !S_ISDIR(status.st_mode));
}

}  // namespace

void take_folder(const char* given) {
  if (given != nullptr) {
    snprintf(folder, sizeof folder, "%s", given);
  } else if (machine_call(SYS_getcwd, folder, sizeof folder) < 0) {
    folder[0] = '\0';
  }
}

const char* own_folder() { return folder; }

OwnPath::OwnPath(const char* path, Use use) : text_(path) {
  if (!is_simulated() || path == nullptr || path[0] != '/' || folder[0] == '\0') return;
  if (is_below(path, folder)) return;
  const char* rest = path;
  const bool is_folder = is_below(path, kFolder);
  if (is_folder) rest += strlen(kFolder);
  // An older name of it.
  if (is_below(rest, "/var/run")) rest += strlen("/var");
  const int written = snprintf(room_, sizeof room_, "%s%s", folder, rest);
  if (written < 0 || static_cast<std::size_t>(written) >= sizeof room_) return;
  const bool creates = use == Use::kCreates && is_own(path);
  if (is_folder || creates || is_there(room_, is_own(path))) text_ = room_;
  if (creates) make_folders(room_);
}

const char* seen_path(const char* path, char* room, std::size_t size) {
  if (folder[0] == '\0' || !is_below(path, folder)) return path;
  const char* rest = path + strlen(folder);
  if (*rest != '\0' && is_own(rest)) return rest;
  snprintf(room, size, "%s%s", kFolder, rest);
  return room;
}

}  // namespace simbench::shim
