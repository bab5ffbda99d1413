#include "processes/warden.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <utility>

#include "processes/own_process_files.h"

namespace simbench::processes {
namespace {

// The warden is a copy of a process that may have had other threads: what follows makes
// async-signal-safe calls only, but for the parent's part.

constexpr int kMessages = 3;  // its descriptor

// What is written whole or not at all.
void tell(int number) {
  while (write(kMessages, &number, sizeof number) < 0 && errno == EINTR) {
  }
}

// Kills each child that it has now; returns whether there were any.
bool kill_children(const char* list) {
  std::array<char, 4096> text{};
  const int file = open(list, O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const ssize_t size = read(file, text.data(), text.size());
  close(file);
  bool any = false;
  const char* at = text.data();
  const char* const end = at + (size > 0 ? size : 0);
  while (at < end) {
    pid_t child = 0;
    const std::from_chars_result number = std::from_chars(at, end, child);
    // A number that the end has cut is looked at next time.
    if (number.ec == std::errc() && number.ptr < end) any |= kill(child, SIGKILL) == 0;
    at = number.ptr + 1;
  }
  return any;
}

void kill_all(pid_t program) {
  std::array<char, 64> list{};
  char* at = stpcpy(list.data(), "/proc/self/task/");
  at = std::to_chars(at, list.data() + list.size(), getpid()).ptr;
  strcpy(at, "/children");
  if (program > 0) kill(program, SIGKILL);  // there may be no such file
  for (;;) {
    const bool any = kill_children(list.data());
    if (waitpid(-1, nullptr, any ? 0 : WNOHANG) < 0 && errno == ECHILD) return;
    if (!any) sched_yield();
  }
}

// Returns once it has killed all.
void watch(pid_t program, const sigset_t& awaited) {
  for (;;) {
    int status = 0;
    pid_t ended = 0;
    while ((ended = waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended != program) continue;
      tell(status);
      program = 0;  // somebody else may get the number
    }
    if (ended < 0) _exit(0);
    if (sigwaitinfo(&awaited, nullptr) == SIGTERM) {
      kill_all(program);
      return;
    }
  }
}

// Nothing of the parent's stays open.
void leave_parent(int messages) {
  if (chdir("/") != 0) _exit(1);
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int each = 0; each < kMessages; ++each) dup2(null, each);
  if (messages != kMessages) dup2(messages, kMessages);
  syscall(SYS_close_range, kMessages + 1, ~0U, 0);
}

[[noreturn]] void guard(pid_t parent, int messages, const std::function<void(pid_t)>& become,
                        const std::function<void()>& orphaned) {
  sigset_t awaited;
  sigemptyset(&awaited);
  sigaddset(&awaited, SIGCHLD);
  sigaddset(&awaited, SIGTERM);
  signal(SIGCHLD, SIG_DFL);
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, &before);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  prctl(PR_SET_NAME, "simbench-warden");
  setpgid(0, 0);
  const pid_t own = getpid();
  const pid_t program = fork();
  if (program == 0) {
    sigprocmask(SIG_SETMASK, &before, nullptr);
    become(own);
    _exit(1);
  }
  const int error = errno;
  leave_parent(messages);
  if (program < 0) {
    tell(-error);
    _exit(1);
  }
  hold_own_process_files(program);
  tell(program);
  watch(program, awaited);
  if (getppid() != parent && orphaned) orphaned();
  _exit(0);
}

// A message of the warden's; nothing if it ended without one.
std::optional<int> message(int messages) {
  int number = 0;
  ssize_t size = 0;
  do {
    size = read(messages, &number, sizeof number);
  } while (size < 0 && errno == EINTR);
  if (size != sizeof number) return std::nullopt;
  return number;
}

}  // namespace

Warden::Warden(const std::function<void(pid_t)>& become, const std::function<void()>& orphaned) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    error_ = errno;
    return;
  }
  const pid_t own = getpid();
  process_ = fork();
  if (process_ == 0) guard(own, ends[1], become, orphaned);
  error_ = process_ < 0 ? errno : 0;
  close(ends[1]);
  messages_ = ends[0];
  if (process_ < 0) return;
  const int told = message(messages_).value_or(-ECHILD);
  if (told > 0) {
    program_ = told;
  } else {
    error_ = -told;
  }
}

Warden::~Warden() { end(); }

Warden::Warden(Warden&& other) noexcept { *this = std::move(other); }

Warden& Warden::operator=(Warden&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(program_, other.program_);
  std::swap(messages_, other.messages_);
  std::swap(error_, other.error_);
  std::swap(status_, other.status_);
  return *this;
}

std::optional<int> Warden::status(std::chrono::milliseconds patience) {
  if (status_ || messages_ < 0) return status_;
  pollfd ready{.fd = messages_, .events = POLLIN, .revents = 0};
  if (poll(&ready, 1, static_cast<int>(patience.count())) > 0) status_ = message(messages_);
  return status_;
}

void Warden::end() {
  if (process_ > 0) {
    status(std::chrono::milliseconds(0));
    kill(process_, SIGTERM);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (messages_ >= 0) close(messages_);
  process_ = program_ = messages_ = -1;
}

}  // namespace simbench::processes
