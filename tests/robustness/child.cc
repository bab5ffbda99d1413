#include "tests/robustness/child.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <stdexcept>

#include "cli/command_line.h"

namespace simbench::robustness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPatience = 2 * kMostSeconds;  // then it is killed

// The fault of a child, and how many of its reads failed, which its parent sees.
const ReadFault* active_fault = nullptr;
std::uint64_t* failed_reads = nullptr;
std::uint64_t bytes_read = 0;

bool is_below(int file, const std::string& folder) {
  char name[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = readlink(link.c_str(), name, sizeof name);
  return size > 0 && std::string_view(name, static_cast<std::size_t>(size)).starts_with(folder);
}

// A file without a name, for what a child prints.
class Memory {
 public:
  Memory() : file_(memfd_create("output", 0)) {
    if (file_ < 0) throw std::runtime_error("no memory for the output of a child");
  }
  ~Memory() { close(file_); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  int file() const { return file_; }
  std::string text() const {
    std::string text(static_cast<std::size_t>(lseek(file_, 0, SEEK_END)), '\0');
    lseek(file_, 0, SEEK_SET);
    const ssize_t size = ::read(file_, text.data(), text.size());
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return text;
  }

 private:
  int file_;
};

[[noreturn]] void be_the_child(const Call& call, const Memory& output, const Memory& messages) {
  // Memory beyond this is refused, so that a machine stays usable.
  const rlimit limit{4 * kMostBytes, 4 * kMostBytes};
  setrlimit(RLIMIT_AS, &limit);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  std::signal(SIGINT, SIG_DFL);
  dup2(output.file(), STDOUT_FILENO);
  dup2(messages.file(), STDERR_FILENO);
  if (call.fault) active_fault = &*call.fault;
  std::vector<std::string> arguments = call.arguments;
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const int status = run_command_line(static_cast<int>(arguments.size()), pointers.data());
  std::fflush(nullptr);
  _exit(status);
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What all threads of a process have taken of the processors.
double cpu_seconds(pid_t process) {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

// Whether the process ends before so many seconds after `start`.
bool ends(int process, Clock::time_point start, double seconds) {
  pollfd poll_for{process, POLLIN, 0};
  for (;;) {
    const double left = seconds - seconds_since(start);
    const int ready = poll(&poll_for, 1, left > 0 ? static_cast<int>(left * 1e3) + 1 : 0);
    if (ready > 0) return true;
    if (ready == 0 && seconds_since(start) >= seconds) return false;
    if (ready < 0 && errno != EINTR) throw std::runtime_error("poll failed");
  }
}

// Waits for the child, interrupts it, and kills it at last.
void watch(pid_t child, const Call& call, Ending& ending) {
  const auto start = Clock::now();
  const int process = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  if (process < 0) throw std::runtime_error("no pidfd");
  bool ended = false;
  std::optional<double> cpu_s_before;  // Ctrl-C
  if (call.interrupt_after_s && !ends(process, start, *call.interrupt_after_s)) {
    cpu_s_before = cpu_seconds(child);
    kill(child, SIGINT);
    ended = ends(process, start, kPatience);
  } else {
    ended = ends(process, start, kPatience);
  }
  if (!ended) kill(child, SIGKILL);
  close(process);
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  ending.seconds = seconds_since(start);
  if (cpu_s_before) {
    ending.cpu_s_after_interrupt =
        seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime) - *cpu_s_before;
  }
  ending.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) << 10U;
  if (WIFEXITED(status)) ending.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ending.signal = WTERMSIG(status);
}

bool has_no_number(const std::string& text) {
  static const std::regex pattern("(^|[^a-z0-9_])[-+]?(nan|inf|infinity)([^a-z0-9_]|$)",
                                  std::regex::icase | std::regex::optimize);
  return std::regex_search(text, pattern);
}

bool tells_a_loss(const Ending& ending) {
  static const std::regex pattern("cannot be read|damaged|lost|ends after", std::regex::optimize);
  return std::regex_search(ending.messages, pattern) || std::regex_search(ending.output, pattern);
}

}  // namespace

Ending call(const Call& call) {
  static auto* const counter = static_cast<std::uint64_t*>(mmap(
      nullptr, sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  failed_reads = counter;
  *counter = 0;
  const Memory output;
  const Memory messages;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no further process");
  if (child == 0) be_the_child(call, output, messages);
  Ending ending;
  watch(child, call, ending);
  ending.failed_reads = *counter;
  ending.output = output.text();
  ending.messages = messages.text();
  return ending;
}

std::optional<std::string> problem_of(const Ending& ending, const std::string& input) {
  const bool interrupted = ending.cpu_s_after_interrupt.has_value();
  if (interrupted && *ending.cpu_s_after_interrupt > kInterruptSeconds) {
    return fmt::format("worked {:.1f} s on after Ctrl-C, allowed: {} s",
                       *ending.cpu_s_after_interrupt, kInterruptSeconds);
  }
  if (ending.seconds > kMostSeconds) return fmt::format("took {:.1f} s", ending.seconds);
  // Before the handler is there, Ctrl-C ends a process as it ends any.
  const bool ended_by_ctrl_c = interrupted && ending.signal == SIGINT;
  if (ending.signal != 0 && !ended_by_ctrl_c) return fmt::format("signal {}", ending.signal);
  if (ending.status == 1) return "status 1, an internal error";
  if (ending.peak_bytes > kMostBytes) {
    return fmt::format("took {} MB", ending.peak_bytes >> 20U);
  }
  if (ending.status == 2 && ending.messages.find("error: ") == std::string::npos) {
    return "status 2 without a message";
  }
  if (ending.failed_reads > 0 && ending.status != 2 && !tells_a_loss(ending)) {
    return fmt::format("status {}, and no word about the read that failed", ending.status);
  }
  if (has_no_number(ending.output) && !has_no_number(input)) return "nan or inf in the output";
  return std::nullopt;
}

}  // namespace simbench::robustness

// In place of the C library's, for this program and the libraries that it uses, so that no read
// escapes it, also one past scenarios/input_file.h: a child with a fault reads as much as it may,
// and then fails.
extern "C" ssize_t read(int file, void* buffer, size_t size) {
  using namespace simbench::robustness;
  if (active_fault != nullptr && is_below(file, active_fault->folder)) {
    const std::uint64_t left = active_fault->after_bytes - bytes_read;
    if (left == 0) {
      ++*failed_reads;
      errno = EIO;
      return -1;
    }
    if (size > left) size = left;
    const ssize_t got = syscall(SYS_read, file, buffer, size);
    if (got > 0) bytes_read += static_cast<std::uint64_t>(got);
    return got;
  }
  return syscall(SYS_read, file, buffer, size);
}
