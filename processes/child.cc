#include "processes/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include "processes/confinement.h"
#include "recording/text_fields.h"

namespace simbench::processes {
namespace {

// Its number in the child: programs use the first ones, and some close those that follow.
constexpr int kLink = 200;
constexpr int kCannotRun = 127;

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

// Between fork() and exec() only async-signal-safe calls are allowed.
struct Plan {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* folder;
  const char* log;
  int link;
  int clock_page;
  pid_t parent;
};

// Says why in the log, which is its error output by then.
[[noreturn]] void fail(const char* what, int error) {
  const char* why = strerrordesc_np(error);
  for (const char* text : {what, ": ", why != nullptr ? why : "?", "\n"}) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  _exit(kCannotRun);
}

void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit both{.rlim_cur = most, .rlim_max = most};
  setrlimit(resource, &both);
}

// Neither signals nor descriptors of the parent's are inherited.
void forget_parent() {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (int each = 1; each < NSIG; ++each) signal(each, SIG_DFL);
  umask(S_IWGRP | S_IWOTH);
  syscall(SYS_close_range, 3, ~0U, CLOSE_RANGE_CLOEXEC);
}

[[noreturn]] void become(const Plan& plan, Confinement& confinement) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != plan.parent) _exit(kCannotRun);
  forget_parent();
  personality(ADDR_NO_RANDOMIZE);
  setpgid(0, 0);  // Ctrl-C at the terminal is the parent's to handle
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, Child::kMostOutput);
  limit(RLIMIT_AS, Child::kMostMemory);
  limit(RLIMIT_NOFILE, Child::kMostDescriptors);
  if (chdir(plan.folder) != 0) _exit(kCannotRun);
  const int input = open("/dev/null", O_RDONLY);
  const int log = open(plan.log, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600);
  if (input < 0 || log < 0 || dup2(input, 0) < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0) {
    _exit(kCannotRun);
  }
  if (dup2(plan.link, kLink) < 0) fail("link", errno);
  if (plan.clock_page >= 0 && dup2(plan.clock_page, shim::kClockPage) < 0) fail("clock", errno);
  if (const Confinement::Failure failure = confinement.apply(); failure.what != nullptr) {
    fail(failure.what, failure.error);
  }
  execve(plan.program, plan.arguments, plan.environment);
  fail(plan.program, errno);
}

}  // namespace

Child::Child(const Settings& settings)
    : name_(std::filesystem::path(settings.command.at(0)).filename()),
      log_(settings.folder + "/" + settings.log_name),
      patience_(settings.patience),
      link_(settings.link),
      served_(settings.served),
      buffer_(shim::kMostData) {
  if (link_ < 0) {
    try {
      obstacle_ = start(settings);
    } catch (const ConfinementError& error) {
      obstacle_ = error.what();
    }
  }
  const auto whole_s = std::chrono::duration_cast<std::chrono::seconds>(patience_);
  const std::chrono::microseconds rest = patience_ - whole_s;
  const timeval patience{.tv_sec = whole_s.count(), .tv_usec = rest.count()};
  setsockopt(link_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

std::string Child::start(const Settings& settings) {
  std::vector<std::string> arguments = settings.command;
  std::vector<std::string> environment = {
      fmt::format("LD_PRELOAD={}", settings.shim), fmt::format("{}={}", shim::kLinkVariable, kLink),
      "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "TZ=UTC0", "LC_ALL=C"};
  for (const auto& [name, value] : settings.environment) {
    environment.push_back(fmt::format("{}={}", name, value));
  }
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const std::string& program =
      settings.program.empty() ? settings.command.front() : settings.program;
  Confinement confinement(settings.folder, program.c_str(), settings.served);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fmt::format("no link: {}", std::strerror(errno));
  }
  const Plan plan{.program = program.c_str(),
                  .arguments = argument_pointers.data(),
                  .environment = environment_pointers.data(),
                  .folder = settings.folder.c_str(),
                  .log = settings.log_name.c_str(),
                  .link = ends[1],
                  .clock_page = settings.clock_page,
                  .parent = getpid()};
  process_ = fork();
  if (process_ == 0) become(plan, confinement);
  const int error = errno;
  close(ends[1]);
  link_ = ends[0];
  return process_ < 0 ? fmt::format("no process: {}", std::strerror(error)) : "";
}

Child::~Child() {
  end();
  if (link_ >= 0) close(link_);
}

void Child::follow_thread() {
  const int cpu = sched_getcpu();
  if (cpu == std::exchange(cpu_, cpu) || cpu < 0 || cpu >= CPU_SETSIZE) return;
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(cpu, &only);
  sched_setaffinity(process_, sizeof only, &only);  // without it all goes on, slower
}

std::optional<ChildRequest> Child::next() {
  if (!obstacle_.empty()) return std::nullopt;
  ChildRequest request;
  std::array<iovec, 2> pieces{
      {{&request.head, sizeof request.head}, {buffer_.data(), buffer_.size()}}};
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  ssize_t size = 0;
  do {
    size = recvmsg(link_, &message, 0);
  } while (size < 0 && errno == EINTR);
  was_too_slow_ = size < 0 && errno == EAGAIN;
  if (size <= 0) return std::nullopt;
  has_asked_ = true;
  const auto whole = static_cast<std::size_t>(size);
  const std::size_t data_size = whole - std::min(whole, sizeof request.head);
  request.is_whole = whole >= sizeof request.head && request.head.size == data_size;
  request.data.assign(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(data_size));
  return request;
}

void Child::reply(std::int64_t value, int error, std::span<const std::byte> data) {
  if (served_ == Served::kAll) follow_thread();
  shim::Reply head{.value = value, .error = error, .size = static_cast<std::uint32_t>(data.size())};
  std::array<iovec, 2> pieces{
      {{&head, sizeof head}, {const_cast<std::byte*>(data.data()), data.size()}}};
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  // A program that is gone is found by next(). One that takes no replies loses them.
  sendmsg(link_, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
}

std::string ProgramEnd::text() const {
  return fmt::format("{}: {}{}{}", program, how, last_words.empty() ? "" : ": ", last_words);
}

ProgramEnd Child::end_of(const std::string& reason) {
  ProgramEnd ended{.program = printable_name(name_)};
  if (!obstacle_.empty()) {
    ended.how = printable_name(obstacle_);
    return ended;
  }
  const std::string how = end();
  ended.how = printable_name(reason.empty() ? how : reason);
  if (reason.empty()) ended.status = exit_status_;
  ended.last_words = printable_name(last_line());
  return ended;
}

std::string Child::end() {
  if (process_ < 0) return "has closed its link";
  int status = 0;
  // One that has closed its link is exiting, and has a moment for it.
  pollfd link{.fd = link_, .events = 0, .revents = 0};
  const int moments = poll(&link, 1, 0) > 0 ? 200 : 0;
  pid_t ended = waitpid(process_, &status, WNOHANG);
  for (int i = 0; i < moments && ended == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ended = waitpid(process_, &status, WNOHANG);
  }
  const bool ended_itself = ended == process_;
  if (!ended_itself) {
    kill(process_, SIGKILL);
    waitpid(process_, &status, 0);
  }
  process_ = -1;
  if (ended_itself && !was_too_slow_ && WIFEXITED(status)) exit_status_ = WEXITSTATUS(status);
  return how_it_ended(ended_itself, status);
}

namespace {

std::string signal_text(int number) {
  switch (number) {
    case SIGXFSZ:
      return fmt::format("wrote more than {} MiB into a file", Child::kMostOutput >> 20U);
    case SIGSYS:
      return "made a system call that is not for programs of the simulated world";
    default:
      break;
  }
  const char* name = sigabbrev_np(number);
  return fmt::format("was ended by signal {}", name != nullptr ? name : std::to_string(number));
}

}  // namespace

std::string Child::how_it_ended(bool itself, int status) const {
  if (was_too_slow_) {
    return fmt::format("computed for {} s without waiting",
                       std::chrono::duration<double>(patience_).count());
  }
  if (!itself) return "was ended";
  if (WIFSIGNALED(status)) return signal_text(WTERMSIG(status));
  if (WEXITSTATUS(status) == kCannotRun && !has_asked_) return "cannot be run";
  return fmt::format("exited with status {}{}", WEXITSTATUS(status),
                     has_asked_ ? "" : ", and the preloaded library was never loaded");
}

namespace {

// Cut to what a row's note has room for, at the begin of a character.
std::string cut(std::string line) {
  constexpr std::size_t kMost = 300;
  if (line.size() <= kMost) return line;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U) --end;
  return line.substr(0, end) + " [...]";
}

}  // namespace

// The log may be long, and need not have lines.
std::string Child::last_line() const {
  constexpr std::streamoff kMost = 4096;
  std::ifstream log(log_, std::ios::binary | std::ios::ate);
  if (!log) return "";
  const std::streamoff begin = std::max<std::streamoff>(0, log.tellg() - kMost);
  log.seekg(begin);
  std::string line;
  std::string last;
  while (std::getline(log, line)) {
    const std::size_t end = line.find_last_not_of(" \t\r");
    if (end != std::string::npos) last = line.substr(0, end + 1);
  }
  return cut(std::move(last));
}

}  // namespace simbench::processes
