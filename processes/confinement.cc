#include "processes/confinement.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <linux/securebits.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace simbench::processes {
namespace {

// The newest kernel knows all of these; the headers may be older.
constexpr std::uint64_t kRead =
    LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
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

bool allow_below(int rules, const char* path, std::uint64_t rights) {
  const int folder = open(path, O_PATH | O_CLOEXEC);
  if (folder < 0) return false;
  const landlock_path_beneath_attr rule{.allowed_access = rights, .parent_fd = folder};
  const long added = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  const int error = errno;
  close(folder);
  errno = error;
  return added == 0;
}

// A descriptor; -1 without Landlock.
int landlock_rules(const std::string& folder) {
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
  const std::uint64_t null_rights = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE;
  if (rules >= 0 && allow_below(rules, "/", kRead) &&
      allow_below(rules, "/dev/null", null_rights) &&
      allow_below(rules, folder.c_str(), handled.files)) {
    return rules;
  }
  const int error = errno;
  if (rules >= 0) close(rules);
  throw ConfinementError(
      fmt::format("{} cannot be made a program's only folder: {}", folder, std::strerror(error)));
}

// What fails here fails for who has no rights to lose.
bool drop_capabilities() {
  for (unsigned long each = 0; prctl(PR_CAPBSET_READ, each, 0, 0, 0) >= 0; ++each) {
    prctl(PR_CAPBSET_DROP, each, 0, 0, 0);
  }
  prctl(PR_SET_SECUREBITS,
        SECBIT_NOROOT | SECBIT_NOROOT_LOCKED | SECBIT_NO_SETUID_FIXUP |
            SECBIT_NO_SETUID_FIXUP_LOCKED | SECBIT_NO_CAP_AMBIENT_RAISE |
            SECBIT_NO_CAP_AMBIENT_RAISE_LOCKED,
        0, 0, 0);
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct head{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  const __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capset, &head, none) == 0;
}

}  // namespace

Confinement::Confinement(const std::string& folder, Served served)
    : rules_(landlock_rules(folder)), filter_(call_filter(served)) {}

Confinement::~Confinement() {
  if (rules_ >= 0) close(rules_);
}

Confinement::Failure Confinement::apply() {
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return {"no_new_privs", errno};
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
