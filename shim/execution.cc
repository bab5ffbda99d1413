// exec() and what starts programs as children: they are preloaded and linked as this one is.
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "shim/children.h"
#include "shim/hidden.h"
#include "shim/link.h"
#include "shim/paths.h"

namespace simbench::shim {
namespace {

constexpr char kPreload[] = "LD_PRELOAD";
constexpr std::size_t kMostDescriptorText = 16'384;
constexpr int kMostScripts = 4;  // one that is run by another, and on

bool names(const char* entry, const char* name) {
  const std::size_t size = strlen(name);
  return strncmp(entry, name, size) == 0 && entry[size] == '=';
}

std::size_t count_words(char* const* words) {
  std::size_t count = 0;
  while (words != nullptr && words[count] != nullptr) ++count;
  return count;
}

// What is not the program's own business.
bool is_of_shim(const char* entry) {
  return names(entry, kPreload) || names(entry, kLinkVariable) ||
         names(entry, kDescriptorsVariable) || names(entry, kFolderVariable);
}

[[noreturn]] void give_up_on(const char* path, const char* why) {
  char text[PATH_MAX + 32];
  snprintf(text, sizeof text, "execve(\"%s\")", path);
  give_up(text, why);
}

// As much of the file as there is.
std::size_t read_at(int file, std::uint64_t offset, void* to, std::size_t size) {
  const long got = machine_call(SYS_pread64, file, to, size, offset);
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

// Whether it loads libraries by glibc's loader.
bool has_loader(int file, const Elf64_Ehdr& head) {
  for (unsigned i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr part{};
    if (read_at(file, head.e_phoff + i * sizeof part, &part, sizeof part) < sizeof part)
      return false;
    if (part.p_type != PT_INTERP) continue;
    char loader[PATH_MAX] = {};
    read_at(file, part.p_offset, loader,
            part.p_filesz < sizeof loader - 1 ? part.p_filesz : sizeof loader - 1);
    return strstr(loader, "/ld-linux") != nullptr;
  }
  return false;
}

// The interpreter of a script, or null.
char* interpreter_in(char* line) {
  if (strncmp(line, "#!", 2) != 0) return nullptr;
  char* rest = nullptr;
  return strtok_r(line + 2, " \t\n", &rest);
}

}  // namespace

bool is_absent_program(const char* path) {
  const char* name = strrchr(path, '/');
  return strcmp(name != nullptr ? name + 1 : path, "ldconfig") == 0;
}

void check_reach(const char* path) {
  char line[PATH_MAX] = {};
  const char* name = path;
  for (int i = 0; i < kMostScripts; ++i) {
    const int file =
        static_cast<int>(machine_call(SYS_openat, AT_FDCWD, name, O_RDONLY | O_CLOEXEC));
    if (file < 0) return;
    struct stat status {};
    Elf64_Ehdr head{};
    const bool is_program = read_at(file, 0, &head, sizeof head) == sizeof head &&
                            memcmp(head.e_ident, ELFMAG, SELFMAG) == 0;
    const bool is_reached = is_program && has_loader(file, head);
    const bool has_rights =
        fstat(file, &status) == 0 && (status.st_mode & (S_ISUID | S_ISGID)) != 0;
    if (!is_program) {
      memset(line, 0, sizeof line);
      read_at(file, 0, line, sizeof line - 1);
    }
    machine_call(SYS_close, file);
    if (has_rights) {
      give_up_on(path,
                 ": it has rights of its own (set-uid), for which preloaded libraries are "
                 "ignored");
    }
    if (is_program && is_reached) return;
    if (is_program) {
      give_up_on(path,
                 ": it is static or of another C library than glibc, which the preloaded "
                 "library cannot reach");
    }
    name = interpreter_in(line);
    if (name == nullptr) return;
  }
}

const char* search(const char* name, char* room, std::size_t size) {
  if (strchr(name, '/') != nullptr) return name;
  const char* folders = getenv("PATH");
  if (folders == nullptr) folders = "/usr/bin:/bin";
  while (*folders != '\0') {
    const char* end = strchrnul(folders, ':');
    const int length = static_cast<int>(end - folders);
    const int written =
        snprintf(room, size, "%.*s%s%s", length, folders, length > 0 ? "/" : "./", name);
    if (written > 0 && static_cast<std::size_t>(written) < size && access(room, X_OK) == 0)
      return room;
    folders = *end == ':' ? end + 1 : end;
  }
  return name;
}

Environment::Environment(char* const* wanted, int link, bool has_descriptors) {
  char descriptors[kMostDescriptorText] = "";
  if (has_descriptors) write_descriptors(descriptors, sizeof descriptors);
  const std::size_t count = count_words(wanted);
  const char* library = shim_path();
  const char* preloaded = "";
  for (std::size_t i = 0; i < count; ++i) {
    if (names(wanted[i], kPreload)) preloaded = wanted[i] + sizeof kPreload;
  }
  const std::size_t text =
      strlen(library) + strlen(preloaded) + strlen(own_folder()) + sizeof descriptors + 256;
  constexpr std::size_t kOwn = 5;  // and the end
  size_ = (count + kOwn) * sizeof(char*) + text;
  void* memory = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return;
  words_ = static_cast<char**>(memory);
  char* place = static_cast<char*>(memory) + (count + kOwn) * sizeof(char*);
  char** next = words_;
  const auto add = [&](const char* format, auto... values) {
    *next++ = place;
    place += snprintf(place, static_cast<std::size_t>(static_cast<char*>(memory) + size_ - place),
                      format, values...) +
             1;
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_of_shim(wanted[i])) *next++ = wanted[i];
  }
  const bool has_others = *preloaded != '\0' && strncmp(preloaded, library, strlen(library)) != 0;
  add("LD_PRELOAD=%s%s%s", library, has_others ? ":" : "", has_others ? preloaded : "");
  add("%s=%d", kLinkVariable, link);
  add("%s=%s", kDescriptorsVariable, descriptors);
  add("%s=%s", kFolderVariable, own_folder());
}

Environment::~Environment() {
  if (words_ != nullptr) munmap(words_, size_);
}

int execute(const char* given, char* const* words, char* const* environment) {
  const OwnPath own_path(given);
  const char* path = own_path.text();
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_execve, path, words, environment));
  if (machine_call(SYS_faccessat, AT_FDCWD, path, X_OK) < 0) return -1;
  if (is_absent_program(path)) return refuse(ENOENT);
  check_reach(path);
  const Environment own(environment, link_number(), true);
  if (own.words() == nullptr) return refuse(ENOMEM);
  ask({.call = Call::kExecute});
  keep_link(true);
  set_counter_hidden(false);
  machine_call(SYS_execve, path, words, own.words());
  const int error = errno;
  set_counter_hidden(true);
  keep_link(false);
  return refuse(error);
}

SIMBENCH_CALL int execve(const char* path, char* const* words, char* const* environment) {
  return execute(path, words, environment);
}

SIMBENCH_CALL int execv(const char* path, char* const* words) {
  return execute(path, words, environ);
}

SIMBENCH_CALL int execvpe(const char* name, char* const* words, char* const* environment) {
  char room[PATH_MAX];
  const char* path = search(name, room, sizeof room);
  execute(path, words, environment);
  if (errno != ENOEXEC) return -1;
  // A script without its first line is the shell's.
  constexpr std::size_t kMostWords = 1024;
  const std::size_t count = count_words(words);
  if (count + 2 > kMostWords) return refuse(E2BIG);
  char shell[] = "/bin/sh";
  char* all[kMostWords] = {shell, const_cast<char*>(path)};
  for (std::size_t i = 1; i < count; ++i) all[i + 1] = words[i];
  return execute(shell, all, environment);
}

SIMBENCH_CALL int execvp(const char* name, char* const* words) {
  return execvpe(name, words, environ);
}

SIMBENCH_CALL int fexecve(int file, char* const* words, char* const* environment) {
  char path[32];
  snprintf(path, sizeof path, "/proc/self/fd/%d", file);
  return execute(path, words, environment);
}

namespace {

constexpr std::size_t kMostListed = 1024;

// The words of execl() and its kin.
struct ListedWords {
  char* words[kMostListed] = {};
  bool fits = true;
  ListedWords(const char* first, va_list more) {
    std::size_t count = 0;
    for (const char* word = first; word != nullptr; word = va_arg(more, const char*)) {
      if (count + 1 == kMostListed) fits = false;
      if (fits) words[count++] = const_cast<char*>(word);
    }
  }
};

}  // namespace

SIMBENCH_CALL int execl(const char* path, const char* first, ...) {
  va_list more;
  va_start(more, first);
  const ListedWords listed(first, more);
  va_end(more);
  return listed.fits ? execute(path, listed.words, environ) : refuse(E2BIG);
}

SIMBENCH_CALL int execlp(const char* name, const char* first, ...) {
  va_list more;
  va_start(more, first);
  const ListedWords listed(first, more);
  va_end(more);
  return listed.fits ? execvpe(name, listed.words, environ) : refuse(E2BIG);
}

SIMBENCH_CALL int execle(const char* path, const char* first, ...) {
  va_list more;
  va_start(more, first);
  const ListedWords listed(first, more);
  char* const* environment = va_arg(more, char* const*);
  va_end(more);
  return listed.fits ? execute(path, listed.words, environment) : refuse(E2BIG);
}

namespace {

// By the real function, which does what the actions and attributes say.
template <class Spawn>
int start_child(Spawn spawn, pid_t* process, const char* path, char* const* environment) {
  if (is_absent_program(path)) return ENOENT;
  const int before = errno;
  check_reach(path);
  Newcomer child;
  if (!announce(Call::kNewProcess, child)) {
    const int error = errno;
    errno = before;
    return error;
  }
  pid_t machine = 0;
  int error = ENOMEM;
  {
    const Environment own(environment, child.link, true);
    machine_call(SYS_fcntl, child.link, F_SETFD, 0);
    set_counter_hidden(false);
    if (own.words() != nullptr) error = spawn(&machine, own.words());
    set_counter_hidden(true);
  }
  if (error == 0) add_child(child.number, machine);
  tell_started(child, false, error == 0 ? machine : 0);
  if (error == 0 && process != nullptr) *process = child.number;
  errno = before;
  return error;
}

}  // namespace

SIMBENCH_CALL int posix_spawn(pid_t* process, const char* path,
                              const posix_spawn_file_actions_t* actions,
                              const posix_spawnattr_t* attributes, char* const* words,
                              char* const* environment) {
  const auto real_one = SIMBENCH_REAL(posix_spawn);
  if (!has_world()) return real_one(process, path, actions, attributes, words, environment);
  if (!is_simulated()) give_up("posix_spawn", ": beside real hosts a program is one process");
  return start_child(
      [&](pid_t* machine, char* const* own) {
        return real_one(machine, path, actions, attributes, words, own);
      },
      process, path, environment);
}

SIMBENCH_CALL int posix_spawnp(pid_t* process, const char* name,
                               const posix_spawn_file_actions_t* actions,
                               const posix_spawnattr_t* attributes, char* const* words,
                               char* const* environment) {
  const auto real_one = SIMBENCH_REAL(posix_spawnp);
  if (!has_world()) return real_one(process, name, actions, attributes, words, environment);
  if (!is_simulated()) give_up("posix_spawnp", ": beside real hosts a program is one process");
  char room[PATH_MAX];
  return start_child(
      [&](pid_t* machine, char* const* own) {
        return real_one(machine, name, actions, attributes, words, own);
      },
      process, search(name, room, sizeof room), environment);
}

namespace {

pid_t start_shell(const char* command, const posix_spawn_file_actions_t* actions,
                  const posix_spawnattr_t* attributes) {
  char shell[] = "sh";
  char option[] = "-c";
  char* const words[] = {shell, option, const_cast<char*>(command), nullptr};
  pid_t child = 0;
  const int error = posix_spawn(&child, "/bin/sh", actions, attributes, words, environ);
  return error == 0 ? child : refuse(error);
}

}  // namespace

SIMBENCH_CALL int system(const char* command) {
  if (!has_world()) return SIMBENCH_REAL(system)(command);
  if (command == nullptr) return 1;
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  struct sigaction before[2] = {};
  sigaction(SIGINT, &ignored, &before[0]);
  sigaction(SIGQUIT, &ignored, &before[1]);
  sigset_t child_signal{};
  sigaddset(&child_signal, SIGCHLD);
  sigset_t mask{};
  sigprocmask(SIG_BLOCK, &child_signal, &mask);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults{};
  for (int i = 0; i < 2; ++i) {
    if (before[i].sa_handler != SIG_IGN) sigaddset(&defaults, i == 0 ? SIGINT : SIGQUIT);
  }
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setsigmask(&attributes, &mask);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  const pid_t child = start_shell(command, nullptr, &attributes);
  posix_spawnattr_destroy(&attributes);
  int status = -1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  sigaction(SIGINT, &before[0], nullptr);
  sigaction(SIGQUIT, &before[1], nullptr);
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  return status;
}

namespace {

struct Opened {
  FILE* file = nullptr;
  pid_t child = 0;
};
Opened opened[64];

}  // namespace

SIMBENCH_CALL FILE* popen(const char* command, const char* mode) {
  if (!has_world()) return SIMBENCH_REAL(popen)(command, mode);
  const bool reads = mode[0] == 'r';
  int ends[2] = {};
  if ((!reads && mode[0] != 'w') || pipe2(ends, O_CLOEXEC) < 0) {
    if (!reads && mode[0] != 'w') errno = EINVAL;
    return nullptr;
  }
  const int own = reads ? ends[0] : ends[1];
  const int theirs = reads ? ends[1] : ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, theirs, reads ? STDOUT_FILENO : STDIN_FILENO);
  const pid_t child = start_shell(command, &actions, nullptr);
  posix_spawn_file_actions_destroy(&actions);
  close(theirs);
  FILE* file = child > 0 ? fdopen(own, reads ? "r" : "w") : nullptr;
  for (Opened& place : opened) {
    if (file == nullptr || place.file != nullptr) continue;
    place = {file, child};
    return file;
  }
  close(own);
  return nullptr;
}

SIMBENCH_CALL int pclose(FILE* file) {
  if (!has_world()) return SIMBENCH_REAL(pclose)(file);
  for (Opened& place : opened) {
    if (place.file != file) continue;
    const pid_t child = place.child;
    place = {};
    fclose(file);
    int status = -1;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }
  return refuse(EINVAL);
}

}  // namespace simbench::shim
