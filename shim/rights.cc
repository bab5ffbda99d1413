// Who the program is: root on its simulated host, where every user and group exists and is root.
//
// The kernel's filter answers most calls (Refusal::kIgnored in shim/refused_calls.h): those that
// drop or ask for rights succeed without effect. This file answers those that fill in memory. No
// user database of the machine is read, so that a run is the same on all machines.
#include <errno.h>
#include <grp.h>
#include <linux/capability.h>
#include <pwd.h>
#include <stdarg.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

constexpr std::size_t kMostUserName = 64;

char no_password[] = "x";
char folder[] = ".";
char shell[] = "/bin/false";
char no_text[] = "";
char* no_members[] = {nullptr};

void fill_entry(passwd& result, char* name) {
  result = {};
  result.pw_name = name;
  result.pw_passwd = no_password;
  result.pw_gecos = no_text;
  result.pw_dir = folder;
  result.pw_shell = shell;
}

void fill_entry(group& result, char* name) {
  result = {};
  result.gr_name = name;
  result.gr_passwd = no_password;
  result.gr_mem = no_members;
}

// Does what getpwnam_r() and getgrnam_r() do.
template <class Entry>
int find_named(const char* name, Entry* result, char* room, std::size_t size, Entry** found) {
  *found = nullptr;
  const std::size_t length = strlen(name);
  if (length >= size) return ERANGE;
  memcpy(room, name, length + 1);
  fill_entry(*result, room);
  *found = result;
  return 0;
}

// Does what getpwnam() and getgrnam() do: the entry is the library's own.
template <class Entry>
Entry* find_named(const char* name) {
  static char room[kMostUserName];
  static Entry entry;
  Entry* found = nullptr;
  find_named(name, &entry, room, sizeof room, &found);
  return found;
}

}  // namespace

SIMBENCH_CALL passwd* getpwnam(const char* name) {
  return has_world() ? find_named<passwd>(name) : SIMBENCH_REAL(getpwnam)(name);
}

SIMBENCH_CALL passwd* getpwuid(uid_t id) {
  if (!has_world()) return SIMBENCH_REAL(getpwuid)(id);
  return id == 0 ? getpwnam("root") : nullptr;
}

SIMBENCH_CALL int getpwnam_r(const char* name, passwd* result, char* room, std::size_t size,
                             passwd** found) {
  if (!has_world()) return SIMBENCH_REAL(getpwnam_r)(name, result, room, size, found);
  return find_named(name, result, room, size, found);
}

SIMBENCH_CALL int getpwuid_r(uid_t id, passwd* result, char* room, std::size_t size,
                             passwd** found) {
  if (!has_world()) return SIMBENCH_REAL(getpwuid_r)(id, result, room, size, found);
  *found = nullptr;
  return id == 0 ? getpwnam_r("root", result, room, size, found) : 0;
}

SIMBENCH_CALL group* getgrnam(const char* name) {
  return has_world() ? find_named<group>(name) : SIMBENCH_REAL(getgrnam)(name);
}

SIMBENCH_CALL group* getgrgid(gid_t id) {
  if (!has_world()) return SIMBENCH_REAL(getgrgid)(id);
  return id == 0 ? getgrnam("root") : nullptr;
}

SIMBENCH_CALL int getgrnam_r(const char* name, group* result, char* room, std::size_t size,
                             group** found) {
  if (!has_world()) return SIMBENCH_REAL(getgrnam_r)(name, result, room, size, found);
  return find_named(name, result, room, size, found);
}

SIMBENCH_CALL int getgrgid_r(gid_t id, group* result, char* room, std::size_t size, group** found) {
  if (!has_world()) return SIMBENCH_REAL(getgrgid_r)(id, result, room, size, found);
  *found = nullptr;
  return id == 0 ? getgrnam_r("root", result, room, size, found) : 0;
}

SIMBENCH_CALL int initgroups(const char* name, gid_t id) {
  if (!has_world()) return SIMBENCH_REAL(initgroups)(name, id);
  return 0;
}

// Daemons look whether they could set clocks. The wrapper of capget() has no header of libc's.
SIMBENCH_CALL int capget(__user_cap_header_struct* head, __user_cap_data_struct* sets) {
  if (!has_world() || sets == nullptr) {
    return static_cast<int>(machine_call(SYS_capget, head, sets));
  }
  const int count = head->version == _LINUX_CAPABILITY_VERSION_1 ? 1 : _LINUX_CAPABILITY_U32S_3;
  for (int i = 0; i < count; ++i) sets[i] = {.effective = ~0U, .permitted = ~0U, .inheritable = 0};
  return 0;
}

SIMBENCH_CALL int prctl(int option, ...) {
  va_list arguments;
  va_start(arguments, option);
  unsigned long words[4];
  for (unsigned long& word : words) word = va_arg(arguments, unsigned long);
  va_end(arguments);
  if (has_world() && option == PR_CAPBSET_READ && words[0] <= CAP_LAST_CAP) return 1;
  if (is_simulated() && option == PR_SET_TSC) return 0;  // it is the world's (shim/hidden.h)
  return static_cast<int>(machine_call(SYS_prctl, option, words[0], words[1], words[2], words[3]));
}

// Root raises its limits; here they stay as they are.
SIMBENCH_CALL int set_limit(int resource, const rlimit* limits) __asm__("setrlimit");
int set_limit(int resource, const rlimit* limits) {
  const long done = machine_call(SYS_prlimit64, 0, resource, limits, nullptr);
  return has_world() && done < 0 && errno == EPERM ? 0 : static_cast<int>(done);
}
SIMBENCH_CALL int set_limit64(int resource, const rlimit* limits) __asm__("setrlimit64");
int set_limit64(int resource, const rlimit* limits) { return set_limit(resource, limits); }

SIMBENCH_CALL int getresuid(uid_t* own, uid_t* effective, uid_t* saved) {
  if (!has_world()) return SIMBENCH_REAL(getresuid)(own, effective, saved);
  *own = *effective = *saved = 0;
  return 0;
}

SIMBENCH_CALL int getresgid(gid_t* own, gid_t* effective, gid_t* saved) {
  if (!has_world()) return SIMBENCH_REAL(getresgid)(own, effective, saved);
  *own = *effective = *saved = 0;
  return 0;
}

}  // namespace simbench::shim
