#include "shim/proc.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <initializer_list>

#include "shim/chance.h"
#include "shim/host_facts.h"
#include "shim/link.h"
#include "shim/paths.h"
#include "shim/status.h"

namespace simbench::shim {
namespace {

constexpr std::size_t kMostText = 2048;
constexpr std::int64_t kHundredth = kSecond / 100;

// What a file holds now; returns how much of the room it takes.
using Tell = int (*)(char* room, std::size_t size);

int tell_uptime(char* room, std::size_t size) {
  const std::int64_t hundredths = host_uptime() / kHundredth;
  const long whole = hundredths / 100;
  const long rest = hundredths % 100;
  return snprintf(room, size, "%ld.%02ld %ld.%02ld\n", whole, rest, whole, rest);
}

int tell_load(char* room, std::size_t size) {
  return snprintf(room, size, "0.00 0.00 0.00 1/1 %d\n", getpid());
}

int tell_use(char* room, std::size_t size) {
  const long begin = host_time().tv_sec - host_uptime() / kSecond;
  return snprintf(room, size,
                  "cpu  0 0 0 0 0 0 0 0 0 0\ncpu0 0 0 0 0 0 0 0 0 0 0\nintr 0\nctxt 0\nbtime %ld\n"
                  "processes 1\nprocs_running 1\nprocs_blocked 0\n",
                  begin);
}

int tell_memory(char* room, std::size_t size) {
  const unsigned long all = kMemory >> 10U;
  const unsigned long free_ones = kFreeMemory >> 10U;
  return snprintf(room, size,
                  "MemTotal: %15lu kB\nMemFree: %16lu kB\nMemAvailable: %11lu kB\n"
                  "Buffers: %16d kB\nCached: %17d kB\nSwapTotal: %14d kB\nSwapFree: %15d kB\n",
                  all, free_ones, free_ones, 0, 0, 0, 0);
}

int tell_clock_source(char* room, std::size_t size) { return snprintf(room, size, "tsc\n"); }

int tell_name(char* room, std::size_t size) {
  const int result = gethostname(room, size - 1);
  if (result < 0) return 0;
  const std::size_t length = strlen(room);
  room[length] = '\n';
  return static_cast<int>(length) + 1;
}

int write_uuid(char* room, std::size_t size, const unsigned char* of) {
  return snprintf(room, size,
                  "%02x%02x%02x%02x-%02x%02x-4%01x%02x-8%01x%02x-%02x%02x%02x%02x%02x%02x\n", of[0],
                  of[1], of[2], of[3], of[4], of[5], of[6] & 0xFU, of[7], of[8] & 0xFU, of[9],
                  of[10], of[11], of[12], of[13], of[14], of[15]);
}

int tell_uuid(char* room, std::size_t size) {
  unsigned char bytes[16];
  take_chance(bytes, sizeof bytes);
  return write_uuid(room, size, bytes);
}

// The host's, always the same.
int tell_boot(char* room, std::size_t size) {
  unsigned char bytes[16] = {};
  memcpy(bytes + sizeof bytes - sizeof identity().address, &identity().address,
         sizeof identity().address);
  return write_uuid(room, size, bytes);
}

// The name of the program, of 15 letters at most, as the kernel has it.
void write_program(char* room, std::size_t size) {
  const char* name = strrchr(program_invocation_name, '/');
  snprintf(room, size, "%.15s", name != nullptr ? name + 1 : program_invocation_name);
}

int tell_process(char* room, std::size_t size) {
  char name[16];
  write_program(name, sizeof name);
  return snprintf(
      room, size,
      "%d (%s) R %d %d %d 0 -1 0 0 0 0 0 0 0 0 0 20 0 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
      "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n",
      getpid(), name, getppid(), getpgrp(), getsid(0));
}

int tell_status(char* room, std::size_t size) {
  char name[16];
  write_program(name, sizeof name);
  return snprintf(room, size,
                  "Name:\t%s\nUmask:\t0022\nState:\tR (running)\nTgid:\t%d\nNgid:\t0\nPid:\t%d\n"
                  "PPid:\t%d\nTracerPid:\t0\nUid:\t0\t0\t0\t0\nGid:\t0\t0\t0\t0\nFDSize:\t64\n"
                  "Groups:\t0\nVmRSS:\t0 kB\nThreads:\t1\n",
                  name, getpid(), gettid(), getppid());
}

int tell_pages(char* room, std::size_t size) { return snprintf(room, size, "0 0 0 0 0 0 0\n"); }

struct Told {
  const char* name;
  Tell tell;
};
// These are the machine's, the others the process's.
constexpr Told kTold[] = {
    {"/proc/uptime", tell_uptime},
    {"/proc/loadavg", tell_load},
    {"/proc/stat", tell_use},
    {"/proc/meminfo", tell_memory},
    {"/proc/sys/kernel/hostname", tell_name},
    {"/proc/sys/kernel/random/uuid", tell_uuid},
    {"/proc/sys/kernel/random/boot_id", tell_boot},
    {"/sys/devices/system/clocksource/clocksource0/current_clocksource", tell_clock_source},
    {"/sys/devices/system/clocksource/clocksource0/available_clocksource", tell_clock_source},
};
constexpr Told kToldOfProcess[] = {
    {"/stat", tell_process}, {"/status", tell_status}, {"/statm", tell_pages}};

// What follows "/proc/self", or the process's own number there; null if it is another path.
const char* within_process(const char* path) {
  constexpr char kProc[] = "/proc/";
  if (strncmp(path, kProc, sizeof kProc - 1) != 0) return nullptr;
  const char* rest = path + sizeof kProc - 1;
  for (const char* each : {"self", "thread-self"}) {
    const std::size_t size = strlen(each);
    if (strncmp(rest, each, size) == 0 && (rest[size] == '/' || rest[size] == '\0')) {
      return rest + size;
    }
  }
  char* end = nullptr;
  const long number = strtol(rest, &end, 10);
  return end != rest && number == getpid() && (*end == '/' || *end == '\0') ? end : nullptr;
}

Tell teller_of(const char* path) {
  if (path == nullptr || path[0] != '/' || !is_simulated()) return nullptr;
  for (const Told& each : kTold) {
    if (strcmp(path, each.name) == 0) return each.tell;
  }
  const char* rest = within_process(path);
  if (rest == nullptr) return nullptr;
  for (const Told& each : kToldOfProcess) {
    if (strcmp(rest, each.name) == 0) return each.tell;
  }
  return nullptr;
}

// Without a name.
int make_file(int flags) {
  const int how = O_RDWR | (flags & (O_CLOEXEC | O_NONBLOCK));
  const long file = machine_call(SYS_openat, AT_FDCWD, own_folder(), how | O_TMPFILE, 0600);
  if (file >= 0) {
    note_made(static_cast<int>(file), "", AT_EMPTY_PATH);
    return static_cast<int>(file);
  }
  char name[PATH_MAX];
  snprintf(name, sizeof name, "%s/.told", own_folder());
  const long named = machine_call(SYS_openat, AT_FDCWD, name, how | O_CREAT | O_EXCL, 0600);
  if (named >= 0) {
    note_made(static_cast<int>(named), "", AT_EMPTY_PATH);
    machine_call(SYS_unlinkat, AT_FDCWD, name, 0);
  }
  return static_cast<int>(named);
}

}  // namespace

bool is_told(const char* path) { return teller_of(path) != nullptr; }

int open_told(const char* path, int flags) {
  const Tell tell = teller_of(path);
  if (tell == nullptr) return refuse(ENOENT);
  if ((flags & O_ACCMODE) != O_RDONLY) return refuse(EACCES);
  char text[kMostText];
  const int size = tell(text, sizeof text);
  const int file = make_file(flags);
  if (file < 0) return -1;
  machine_call(SYS_write, file, text, size > 0 ? size : 0);
  machine_call(SYS_lseek, file, 0, SEEK_SET);
  return file;
}

bool is_of_process(const char* path) {
  if (strncmp(path, "/sys/", 5) == 0) return false;
  if (strncmp(path, "/proc/", 6) != 0) return true;
  const char* rest = within_process(path);
  if (rest == nullptr) return false;
  for (const char* each :
       {"cmdline", "comm", "cwd", "exe", "fd", "fdinfo", "limits", "maps", "root", "task"}) {
    const std::size_t size = strlen(each);
    if (rest[0] == '/' && strncmp(rest + 1, each, size) == 0) return true;
  }
  return rest[0] == '\0';
}

}  // namespace simbench::shim
