#include "shim/paths.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/proc.h"
#include "shim/status.h"

namespace simbench::shim {
namespace {

char folder[PATH_MAX];

// What is the host's own.
constexpr const char* kOwn[] = {"/run", "/var", "/tmp", "/dev/shm"};
// What of the machine's it may read, without waiting for another's end of a pipe.
constexpr int kToLook = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

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

bool is_own_folder(const char* path) {
  for (const char* each : kOwn) {
    if (strcmp(path, each) == 0) return true;
  }
  return false;
}

bool is_readable(const char* path) {
  const int before = errno;
  const long file = machine_call(SYS_openat, AT_FDCWD, path, kToLook);
  if (file >= 0) machine_call(SYS_close, file);
  errno = before;
  return file >= 0;
}

// Whether the host has none although the machine may: what is not for the program to read.
bool is_absent(const char* path) {
  return is_own(path) ? !is_readable(path) : !is_of_process(path);
}

// If there is none.
void make_folder(const char* path) {
  if (machine_call(SYS_mkdirat, AT_FDCWD, path, 0755) == 0) note_made(AT_FDCWD, path);
}

// The folders that lead to it, within the host's folder.
void make_folders(char* path) {
  const int before = errno;
  const long mask = machine_call(SYS_umask, 0);
  for (char* slash = path + strlen(folder) + 1; (slash = strchr(slash, '/')) != nullptr; ++slash) {
    *slash = '\0';
    make_folder(path);
    *slash = '/';
  }
  machine_call(SYS_umask, mask);
  errno = before;
}

// `kind`: S_IFDIR; 0: any.
bool is_there(const char* path, mode_t kind = 0) {
  const int before = errno;
  struct stat status {};
  const bool found =
      machine_call(SYS_newfstatat, AT_FDCWD, path, &status, AT_SYMLINK_NOFOLLOW) == 0;
  errno = before;
  return found && (kind == 0 || (status.st_mode & S_IFMT) == kind);
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

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): room_ is filled if it is used
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
  const bool is_whole = is_own_folder(path);
  const bool creates = is_whole || (use == Use::kCreates && is_own(path));
  if (creates) make_folders(room_);
  if (is_whole) make_folder(room_);
  const bool is_alone = is_folder || is_whole || is_absent(path);
  if (!is_alone && !creates && !is_there(room_)) return;
  const bool is_machines =
      !is_alone && !is_own(path) && is_there(room_, S_IFDIR) && is_there(path, S_IFDIR);
  text_ = is_machines ? path : room_;
  if (!is_alone) besides_ = is_machines ? room_ : path;
}

const char* seen_path(const char* path, char* room, std::size_t size) {
  if (folder[0] == '\0' || !is_below(path, folder)) return path;
  const char* rest = path + strlen(folder);
  if (*rest != '\0' && is_own(rest)) return rest;
  snprintf(room, size, "%s%s", kFolder, rest);
  return room;
}

}  // namespace simbench::shim
