// What libstdc++ and simbench ask of a newer glibc than the one that a portable library is linked
// with (cmake/portable.cmake). The library's own, and seen by nothing else.
//
// Source: the GNU C Library's manual, "Finding the Object that a Code Address Belongs To";
// sys/single_threaded.h, string.h.
#include <dlfcn.h>
#include <link.h>
#include <sys/random.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>

namespace {

struct Search {
  std::uintptr_t code;
  dl_find_object* found;
};

// Whether this object has the code, and then where its table for exceptions is.
int look_into(dl_phdr_info* object, std::size_t /*size*/, void* data) {
  auto& search = *static_cast<Search*>(data);
  bool has_code = false;
  void* table = nullptr;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
    if (part.p_type == PT_LOAD && search.code - begin < part.p_memsz) {
      has_code = true;
      search.found->dlfo_map_start = reinterpret_cast<void*>(begin);
      search.found->dlfo_map_end = reinterpret_cast<void*>(begin + part.p_memsz);
    }
    if (part.p_type == PT_GNU_EH_FRAME) table = reinterpret_cast<void*>(begin);
  }
  if (!has_code || table == nullptr) return 0;
  search.found->dlfo_eh_frame = table;
  return 1;
}

}  // namespace

extern "C" {

// glibc 2.32: whether atomic operations may be plain ones. "No" is always right.
char __libc_single_threaded = 0;

// glibc 2.35, for exceptions: 0 if found, else -1.
int _dl_find_object(void* code, dl_find_object* found) noexcept {
  *found = {};
  Search search{.code = reinterpret_cast<std::uintptr_t>(code), .found = found};
  return dl_iterate_phdr(&look_into, &search) == 1 ? 0 : -1;
}

// glibc 2.36, for std::random_device: chance of the kernel's.
std::uint32_t arc4random() noexcept {
  std::uint32_t value = 0;
  if (getrandom(&value, sizeof value, 0) != sizeof value) std::abort();
  return value;
}

// glibc 2.32. Its texts are those of the table that older versions had.
extern const char* const sys_errlist[];
extern int sys_nerr;
const char* strerrordesc_np(int error) noexcept {
  return error >= 0 && error < sys_nerr ? sys_errlist[error] : nullptr;
}

// glibc 2.32. The numbers are those of x86_64 and of 64-bit Arm (signal(7)).
const char* sigabbrev_np(int number) noexcept {
  constexpr const char* kNames[] = {
      nullptr, "HUP",  "INT",  "QUIT", "ILL",    "TRAP",   "ABRT",  "BUS",  "FPE",  "KILL", "USR1",
      "SEGV",  "USR2", "PIPE", "ALRM", "TERM",   "STKFLT", "CHLD",  "CONT", "STOP", "TSTP", "TTIN",
      "TTOU",  "URG",  "XCPU", "XFSZ", "VTALRM", "PROF",   "WINCH", "POLL", "PWR",  "SYS"};
  return number > 0 && static_cast<std::size_t>(number) < std::size(kNames) ? kNames[number]
                                                                            : nullptr;
}

// Debian's libbz2.a is no position-independent code: it reads these where they are, which may not
// be in another library. The linker puts ours in their place (--wrap).
extern FILE* __real_stdin;
extern FILE* __real_stdout;
extern FILE* __real_stderr;
FILE* __wrap_stdin = nullptr;
FILE* __wrap_stdout = nullptr;
FILE* __wrap_stderr = nullptr;

__attribute__((constructor(101))) static void take_streams() {
  __wrap_stdin = __real_stdin;
  __wrap_stdout = __real_stdout;
  __wrap_stderr = __real_stderr;
}

}  // extern "C"
