#include "sim/programs/host_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/ports/time.h"
#include "shim/protocol.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

std::int64_t file_ns(const statx_timestamp& time) { return time.tv_sec * kSecondNs + time.tv_nsec; }

std::optional<struct statx> status_of(int parent, const char* name) {
  struct statx status {};
  const int flags = AT_SYMLINK_NOFOLLOW | AT_EMPTY_PATH;
  if (statx(parent, name, flags, STATX_BASIC_STATS | STATX_BTIME, &status) != 0) {
    return std::nullopt;
  }
  return status;
}

// But for "." and "..".
std::vector<std::string> names_in(int folder) {
  std::vector<std::string> names;
  DIR* listing = fdopendir(dup(folder));
  if (listing == nullptr) return names;
  while (const dirent* entry = readdir(listing)) {
    if (std::strcmp(entry->d_name, ".") == 0 || std::strcmp(entry->d_name, "..") == 0) continue;
    names.emplace_back(entry->d_name);
  }
  closedir(listing);
  return names;
}

}  // namespace

HostFiles::HostFiles(SimHost& host, std::string folder) : host_(host), folder_(std::move(folder)) {}

std::int64_t HostFiles::host_now() const {
  return epoch_ns(host_.system_clock().read(host_.true_now()));
}

HostFiles::Seen HostFiles::look(const shim::FileSight& sight) {
  const Key key{sight.device, sight.file, sight.born};
  auto found = files_.find(key);
  if (found == files_.end() || sight.is_new != 0) {
    if (last_number_ >= kMost) return {.number = -1, .modified = host_now()};
    found = files_.insert_or_assign(key, File{.number = ++last_number_}).first;
  }
  File& file = found->second;
  if (sight.modified != 0 && std::exchange(file.by_machine, sight.modified) != sight.modified) {
    file.by_host = host_now();
  }
  return {.number = file.number, .modified = file.by_host};
}

void HostFiles::stamp_all() {
  const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return;
  if (const auto status = status_of(folder, "")) {
    const bool has_birth = (status->stx_mask & STATX_BTIME) != 0;
    const std::int64_t born = file_ns(has_birth ? status->stx_btime : status->stx_ctime);
    stamp_within(folder, born);
    stamp(folder, "", born);
  }
  ::close(folder);
}

void HostFiles::stamp_within(int folder, std::int64_t born) {
  for (const std::string& name : names_in(folder)) {
    const int below = openat(folder, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (below >= 0) {
      stamp_within(below, born);
      ::close(below);
    }
    stamp(folder, name.c_str(), born);
  }
}

void HostFiles::stamp(int parent, const char* name, std::int64_t born) {
  const auto status = status_of(parent, name);
  if (!status) return;
  const std::int64_t modified = file_ns(status->stx_mtime);
  if (!shim::is_of_machine(born, modified, file_ns(status->stx_ctime))) return;
  const Seen seen = look({.device = makedev(status->stx_dev_major, status->stx_dev_minor),
                          .file = status->stx_ino,
                          .born = file_ns(status->stx_btime),
                          .modified = modified});
  const timespec time{.tv_sec = seen.modified / kSecondNs, .tv_nsec = seen.modified % kSecondNs};
  const timespec both[] = {time, time};
  utimensat(parent, name, both, AT_SYMLINK_NOFOLLOW | (*name == '\0' ? AT_EMPTY_PATH : 0));
}

}  // namespace simbench::sim
