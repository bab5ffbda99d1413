#include "processes/control_group.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

namespace simbench::processes {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNameBegin = "simbench-";

// Whether the kernel took it.
bool set(const fs::path& file, const std::string& value) {
  const int open_file = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (open_file < 0) return false;
  const ssize_t written = write(open_file, value.data(), value.size());
  close(open_file);
  return written == static_cast<ssize_t>(value.size());
}

void remove_group(const fs::path& group) {
  set(group / "cgroup.kill", "1");
  constexpr int kTries = 100;  // those killed take a moment
  for (int i = 0; i < kTries && rmdir(group.c_str()) != 0 && errno == EBUSY; ++i) usleep(1000);
}

// The process that made the group of this name; 0: none of ours.
pid_t maker_of(std::string_view name) {
  if (!name.starts_with(kNameBegin)) return 0;
  name.remove_prefix(kNameBegin.size());
  pid_t maker = 0;
  std::from_chars(name.data(), name.data() + name.size(), maker);
  return maker;
}

void remove_left(const fs::path& parent) {
  std::error_code unreadable;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, unreadable)) {
    const pid_t maker = maker_of(entry.path().filename().native());
    if (maker > 0 && kill(maker, 0) != 0 && errno == ESRCH) remove_group(entry.path());
  }
}

// The root of the tree of control groups.
fs::path mount_point() {
  std::ifstream mounts("/proc/self/mounts");
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream fields(line);
    std::string device;
    std::string place;
    std::string type;
    if (fields >> device >> place >> type && type == "cgroup2") return place;
  }
  return "";
}

}  // namespace

fs::path own_control_group() {
  constexpr std::string_view kVersion2 = "0::/";
  const fs::path root = mount_point();
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; !root.empty() && std::getline(groups, line);) {
    if (!line.starts_with(kVersion2)) continue;
    const fs::path own = (root / line.substr(kVersion2.size())).lexically_normal();
    return own.filename().empty() ? own.parent_path() : own;
  }
  return "";
}

ControlGroup::ControlGroup(const Limits& limits) {
  static std::atomic<unsigned> made{0};
  const fs::path own = own_control_group();
  if (own.empty()) return;
  const std::string name = fmt::format("{}{}-{}", kNameBegin, getpid(), made++);
  std::error_code none;
  const bool is_root = !fs::exists(own.parent_path() / "cgroup.procs", none);
  // Beside it the controllers are on; below it they are not where processes are in it.
  for (const fs::path& parent : {is_root ? own : own.parent_path(), own}) {
    remove_left(parent);
    if (mkdir((parent / name).c_str(), 0755) != 0) continue;
    path_ = parent / name;
    entrance_ = open((path_ / "cgroup.procs").c_str(), O_WRONLY | O_CLOEXEC);
    break;
  }
  if (path_.empty()) return;
  set(path_ / "memory.max", std::to_string(limits.memory));
  set(path_ / "memory.swap.max", "0");
  set(path_ / "pids.max", std::to_string(limits.processes));
}

ControlGroup::~ControlGroup() {
  if (entrance_ >= 0) close(entrance_);
  if (!path_.empty()) remove_group(path_);
}

bool ControlGroup::has_run_out() const {
  std::ifstream events(path_ / "memory.events");
  std::string name;
  std::uint64_t count = 0;
  while (events >> name >> count) {
    if (name == "oom_kill" && count > 0) return true;
  }
  return false;
}

}  // namespace simbench::processes
