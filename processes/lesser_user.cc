#include "processes/lesser_user.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace simbench::processes {
namespace {

namespace fs = std::filesystem;

// Whether a namespace of users (user_namespaces(7)) has the number.
bool has_number(const char* map) {
  std::ifstream lines(map);
  std::uint64_t inside = 0;
  std::uint64_t outside = 0;
  std::uint64_t count = 0;
  while (lines >> inside >> outside >> count) {
    if (kNobody >= inside && kNobody - inside < count) return true;
  }
  return !fs::exists(map);  // a kernel without them
}

bool may_change_user() {
  __user_cap_header_struct head{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  __user_cap_data_struct own[_LINUX_CAPABILITY_U32S_3] = {};
  if (syscall(SYS_capget, &head, own) != 0) return false;
  constexpr std::uint32_t kNeeded = 1U << CAP_SETUID | 1U << CAP_SETGID | 1U << CAP_CHOWN;
  return (own[0].effective & kNeeded) == kNeeded;
}

// What stands between the path and everybody.
std::string obstacle_on(const fs::path& path) {
  if (path.empty()) return "";
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return "";
  fs::path part;
  for (const fs::path& each : whole) {
    part /= each;
    struct stat status {};
    if (stat(part.c_str(), &status) != 0) return "";
    const bool is_folder = S_ISDIR(status.st_mode);
    const bool is_last = part == whole;
    const mode_t needed = (is_folder ? S_IXOTH : 0U) | (is_last && !is_folder ? S_IROTH : 0U);
    if (status.st_uid != kNobody && (status.st_mode & needed) != needed) return part.string();
  }
  return "";
}

}  // namespace

bool is_root() { return geteuid() == 0; }

std::string obstacle_to_nobody(const std::vector<std::string>& paths) {
  if (!has_number("/proc/self/uid_map") || !has_number("/proc/self/gid_map")) {
    return "there is no such user";
  }
  if (!may_change_user()) return "root may not change its user";
  for (const std::string& path : paths) {
    const std::string obstacle = obstacle_on(path);
    if (!obstacle.empty()) return fmt::format("nobody may not enter or read {}", obstacle);
  }
  return "";
}

void give_to_nobody(int descriptor) {
  if (fchown(descriptor, kNobody, kNobody) != 0) errno = 0;  // it stays root's
}

void give_to_nobody(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  give_to_nobody(file);
  close(file);
}

void let_pass(const std::string& folder) {
  if (is_root()) chmod(folder.c_str(), 0711);
}

// By the calls themselves: the library's would change all threads.
bool become_nobody() {
  return syscall(SYS_setgroups, 0, nullptr) == 0 &&
         syscall(SYS_setresgid, kNobody, kNobody, kNobody) == 0 &&
         syscall(SYS_setresuid, kNobody, kNobody, kNobody) == 0;
}

}  // namespace simbench::processes
