#include "processes/confinement.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <linux/securebits.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

#include "processes/lesser_user.h"
#include "processes/own_process_files.h"

namespace simbench::processes {
namespace {

// The newest kernel knows all of these; the headers may be older.
constexpr std::uint64_t kRead =
    LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
// What can be said of a file that is no folder.
constexpr std::uint64_t kOfFiles =
    LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE;
constexpr std::uint64_t kMakeAndRemove = 0x1FF0;      // each kind of file, since version 1
constexpr std::uint64_t kRefer = 1U << 13U;           // since version 2: links and moves
constexpr std::uint64_t kTruncate = 1U << 14U;        // 3
constexpr std::uint64_t kDeviceSettings = 1U << 15U;  // 5: ioctl()
constexpr std::uint64_t kTcp = 3;                     // 4: bind and connect
constexpr std::uint64_t kScopes = 3;                  // 6: abstract sockets and signals

struct LandlockRules {
  std::uint64_t files = 0;
  std::uint64_t network = 0;
  std::uint64_t scopes = 0;
};

// What this version handles, and how much of the structure it knows.
std::pair<LandlockRules, std::size_t> rules_of(long version) {
  LandlockRules rules{.files = kRead | LANDLOCK_ACCESS_FS_WRITE_FILE | kMakeAndRemove};
  std::size_t size = sizeof rules.files;
  if (version >= 2) rules.files |= kRefer;
  if (version >= 3) rules.files |= kTruncate;
  if (version >= 5) rules.files |= kDeviceSettings;
  if (version >= 4) {
    rules.network = kTcp;
    size += sizeof rules.network;
  }
  if (version >= 6) {
    rules.scopes = kScopes;
    size += sizeof rules.scopes;
  }
  return {rules, size};
}

// Makes async-signal-safe calls only.
bool allow_below(int rules, const char* path, std::uint64_t rights) {
  const int folder = open(path, O_PATH | O_CLOEXEC);
  if (folder < 0) return false;
  struct stat status {};
  if (fstat(folder, &status) == 0 && !S_ISDIR(status.st_mode)) rights &= kOfFiles;
  const landlock_path_beneath_attr rule{.allowed_access = rights, .parent_fd = folder};
  const long added = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  const int error = errno;
  close(folder);
  errno = error;
  return added == 0;
}

// A descriptor; -1 without Landlock.
int landlock_rules(const Confinement::Settings& settings) {
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version <= 0) {
    if (geteuid() != 0) return -1;
    throw ConfinementError(
        "this kernel has no Landlock, without which root's programs could write to all files: run "
        "simbench as another user");
  }
  const auto [handled, size] = rules_of(version);
  const int rules = static_cast<int>(syscall(SYS_landlock_create_ruleset, &handled, size, 0));
  if (rules >= 0) {
    // Most of what is usually there may not be.
    for (const std::string& path : settings.readable) allow_below(rules, path.c_str(), kRead);
    for (const char* device : {"/dev/null", "/dev/zero", "/dev/full"}) {
      allow_below(rules, device, LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE);
    }
    if (allow_below(rules, settings.folder.c_str(), handled.files)) return rules;
  }
  const int error = errno;
  if (rules >= 0) close(rules);
  throw ConfinementError(fmt::format("{} cannot be made a program's only folder: {}",
                                     settings.folder, std::strerror(error)));
}

// Asked before a run, of which every program would end.
void require_filters() {
  const std::uint32_t action = SECCOMP_RET_TRAP;
  if (syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0) return;
  throw ConfinementError(
      "this kernel has no seccomp filters (Linux has them from 4.14 on, emulators of processors do "
      "not), without which simbench runs no real programs; its own algorithms need none");
}

// What fails here fails for who has no rights to lose.
void keep_from_gaining() {
  for (unsigned long each = 0; prctl(PR_CAPBSET_READ, each, 0, 0, 0) >= 0; ++each) {
    prctl(PR_CAPBSET_DROP, each, 0, 0, 0);
  }
  prctl(PR_SET_SECUREBITS,
        SECBIT_NOROOT | SECBIT_NOROOT_LOCKED | SECBIT_NO_SETUID_FIXUP |
            SECBIT_NO_SETUID_FIXUP_LOCKED | SECBIT_NO_CAP_AMBIENT_RAISE |
            SECBIT_NO_CAP_AMBIENT_RAISE_LOCKED,
        0, 0, 0);
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
}

bool drop_capabilities() {
  __user_cap_header_struct head{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  const __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capset, &head, none) == 0;
}

// Without /proc there is nothing to read.
void allow_own_process_files(int rules) {
  std::array<char, 64> name{};
  char* const file = stpcpy(name.data(), "/proc/self/");
  for (const char* each : kOwnProcessFiles) {
    strcpy(file, each);
    allow_below(rules, name.data(), LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR);
  }
}

}  // namespace

Confinement::Confinement(const Settings& settings)
    : as_nobody_(settings.as_nobody), filter_(call_filter(settings.served)) {
  require_filters();  // first: without them another user cannot help
  rules_ = landlock_rules(settings);
}

Confinement::~Confinement() {
  if (rules_ >= 0) close(rules_);
}

Confinement::Failure Confinement::apply() {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return {"no_new_privs", errno};
  keep_from_gaining();
  if (rules_ >= 0) allow_own_process_files(rules_);
  if (as_nobody_ && !become_nobody()) return {"nobody", errno};
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // another user forgets it
  if (!drop_capabilities()) return {"capset", errno};
  if (rules_ >= 0 && syscall(SYS_landlock_restrict_self, rules_, 0) != 0) {
    return {"landlock", errno};
  }
  set_own_process(filter_, static_cast<std::uint32_t>(getpid()));
  const sock_fprog program{.len = static_cast<unsigned short>(filter_.size()),
                           .filter = filter_.data()};
  if (syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program) !=
      0) {
    return {"seccomp", errno};
  }
  return {};
}

}  // namespace simbench::processes
