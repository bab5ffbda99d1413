// What programs ask of the machine: how long it runs, what they have used of it, how large it is.
#include "shim/host_facts.h"

#include <errno.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/statfs.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>
#include <sys/times.h>
#include <time.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/paths.h"

namespace simbench::shim {
namespace {

constexpr std::int64_t kTick = 10'000'000;  // of times(), ns
constexpr long kExt4 = 0xEF53;
constexpr std::uint64_t kMostFiles = 1U << 22U;

}  // namespace

std::int64_t host_uptime() { return ask({.call = Call::kReadClock, .a = CLOCK_MONOTONIC, .b = 1}); }

// What a program uses: time stands still while it computes.

SIMBENCH_CALL clock_t times(struct tms* used) {
  if (!is_simulated()) return SIMBENCH_REAL(times)(used);
  if (used != nullptr) *used = {};
  return host_uptime() / kTick;
}

SIMBENCH_CALL int usage_of(int who, struct rusage* used) __asm__("getrusage");
int usage_of(int who, struct rusage* used) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_getrusage, who, used));
  if (who != RUSAGE_SELF && who != RUSAGE_CHILDREN && who != RUSAGE_THREAD) return refuse(EINVAL);
  *used = {};
  return 0;
}

SIMBENCH_CALL int getloadavg(double* loads, int count) {
  if (!is_simulated()) return SIMBENCH_REAL(getloadavg)(loads, count);
  constexpr int kMost = 3;
  const int known = count < kMost ? count : kMost;
  for (int i = 0; i < known; ++i) loads[i] = 0;
  return known;
}

SIMBENCH_CALL int facts_of_host(struct sysinfo* facts) __asm__("sysinfo");
int facts_of_host(struct sysinfo* facts) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_sysinfo, facts));
  *facts = {};
  facts->uptime = host_uptime() / kSecond;
  facts->totalram = kMemory;
  facts->freeram = kFreeMemory;
  facts->procs = 1;
  facts->mem_unit = 1;
  return 0;
}

// Processors.

SIMBENCH_CALL int sched_getaffinity(pid_t process, std::size_t size, cpu_set_t* set) noexcept {
  if (!is_simulated()) return SIMBENCH_REAL(sched_getaffinity)(process, size, set);
  if (size < sizeof(unsigned long)) return refuse(EINVAL);
  CPU_ZERO_S(size, set);
  CPU_SET_S(0, size, set);
  return 0;
}

SIMBENCH_CALL int sched_getcpu() noexcept {
  return is_simulated() ? 0 : SIMBENCH_REAL(sched_getcpu)();
}

SIMBENCH_CALL int getcpu(unsigned int* processor, unsigned int* node) noexcept {
  if (!is_simulated()) return SIMBENCH_REAL(getcpu)(processor, node);
  if (processor != nullptr) *processor = 0;
  if (node != nullptr) *node = 0;
  return 0;
}

SIMBENCH_CALL int get_nprocs() noexcept { return is_simulated() ? 1 : SIMBENCH_REAL(get_nprocs)(); }
SIMBENCH_CALL int get_nprocs_conf() noexcept {
  return is_simulated() ? 1 : SIMBENCH_REAL(get_nprocs_conf)();
}
SIMBENCH_CALL long get_phys_pages() noexcept {
  return is_simulated() ? kMemory / kPageSize : SIMBENCH_REAL(get_phys_pages)();
}
SIMBENCH_CALL long get_avphys_pages() noexcept {
  return is_simulated() ? kFreeMemory / kPageSize : SIMBENCH_REAL(get_avphys_pages)();
}

SIMBENCH_CALL long sysconf(int name) noexcept {
  if (is_simulated()) {
    switch (name) {
      case _SC_NPROCESSORS_ONLN:
      case _SC_NPROCESSORS_CONF:
        return 1;
      case _SC_PHYS_PAGES:
        return get_phys_pages();
      case _SC_AVPHYS_PAGES:
        return get_avphys_pages();
      default:
        break;
    }
  }
  return SIMBENCH_REAL(sysconf)(name);
}

// The disk.

namespace {

int show_disk(int result, struct statfs* disk) {
  if (result < 0 || !is_simulated()) return result;
  *disk = {};
  disk->f_type = kExt4;
  disk->f_bsize = kPageSize;
  disk->f_frsize = kPageSize;
  disk->f_blocks = kDiskBlocks;
  disk->f_bfree = kDiskBlocks / 2;
  disk->f_bavail = kDiskBlocks / 2;
  disk->f_files = kMostFiles;
  disk->f_ffree = kMostFiles / 2;
  disk->f_namelen = 255;
  return 0;
}

int show_disk(int result, struct statvfs* disk) {
  if (result < 0 || !is_simulated()) return result;
  *disk = {};
  disk->f_bsize = kPageSize;
  disk->f_frsize = kPageSize;
  disk->f_blocks = kDiskBlocks;
  disk->f_bfree = kDiskBlocks / 2;
  disk->f_bavail = kDiskBlocks / 2;
  disk->f_files = kMostFiles;
  disk->f_ffree = kMostFiles / 2;
  disk->f_favail = kMostFiles / 2;
  disk->f_namemax = 255;
  return 0;
}

}  // namespace

SIMBENCH_CALL int disk_of(const char* path, struct statfs* disk) __asm__("statfs");
int disk_of(const char* path, struct statfs* disk) {
  return show_disk(static_cast<int>(machine_call(SYS_statfs, OwnPath(path).text(), disk)), disk);
}
SIMBENCH_CALL int disk_of_open(int fd, struct statfs* disk) __asm__("fstatfs");
int disk_of_open(int fd, struct statfs* disk) {
  return show_disk(static_cast<int>(machine_call(SYS_fstatfs, fd, disk)), disk);
}
SIMBENCH_CALL int facts_of_disk(const char* path, struct statvfs* disk) __asm__("statvfs");
int facts_of_disk(const char* path, struct statvfs* disk) {
  return show_disk(real(&facts_of_disk, "statvfs")(OwnPath(path).text(), disk), disk);
}
SIMBENCH_CALL int facts_of_open_disk(int fd, struct statvfs* disk) __asm__("fstatvfs");
int facts_of_open_disk(int fd, struct statvfs* disk) {
  return show_disk(real(&facts_of_open_disk, "fstatvfs")(fd, disk), disk);
}
SIMBENCH_CALL int statfs64(const char*, struct statfs64*) __attribute__((alias("statfs")));
SIMBENCH_CALL int fstatfs64(int, struct statfs64*) __attribute__((alias("fstatfs")));
SIMBENCH_CALL int statvfs64(const char*, struct statvfs64*) __attribute__((alias("statvfs")));
SIMBENCH_CALL int fstatvfs64(int, struct statvfs64*) __attribute__((alias("fstatvfs")));

}  // namespace simbench::shim
