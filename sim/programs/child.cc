#include "sim/programs/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <thread>

namespace simbench::sim {
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
  char* const* arguments;
  char* const* environment;
  const char* folder;
  const char* log;
  int link;
  pid_t parent;
};

void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit both{.rlim_cur = most, .rlim_max = most};
  setrlimit(resource, &both);
}

[[noreturn]] void become(const Plan& plan) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != plan.parent) _exit(kCannotRun);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  personality(ADDR_NO_RANDOMIZE);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);  // Ctrl-C at the terminal is the parent's to handle
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, Child::kMostOutput);
  limit(RLIMIT_AS, Child::kMostMemory);
  if (chdir(plan.folder) != 0) _exit(kCannotRun);
  const int input = open("/dev/null", O_RDONLY);
  const int log = open(plan.log, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (input < 0 || log < 0 || dup2(input, 0) < 0 || dup2(log, 1) < 0 || dup2(log, 2) < 0 ||
      dup2(plan.link, kLink) < 0) {
    _exit(kCannotRun);
  }
  close(input);
  close(log);
  execve(plan.arguments[0], plan.arguments, plan.environment);
  _exit(kCannotRun);
}

}  // namespace

Child::Child(const Settings& settings)
    : log_(settings.folder + "/" + settings.log_name), buffer_(shim::kMostData) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw ChildError(fmt::format("{}: no link: {}", settings.command[0], std::strerror(errno)));
  }
  std::vector<std::string> arguments = settings.command;
  std::vector<std::string> environment = {
      fmt::format("LD_PRELOAD={}", settings.shim), fmt::format("{}={}", shim::kLinkVariable, kLink),
      "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "TZ=UTC0", "LC_ALL=C"};
  for (const auto& [name, value] : settings.environment) {
    environment.push_back(fmt::format("{}={}", name, value));
  }
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const Plan plan{.arguments = argument_pointers.data(),
                  .environment = environment_pointers.data(),
                  .folder = settings.folder.c_str(),
                  .log = settings.log_name.c_str(),
                  .link = ends[1],
                  .parent = getpid()};
  process_ = fork();
  if (process_ == 0) become(plan);
  const int error = errno;
  close(ends[1]);
  link_ = ends[0];
  const timeval patience{.tv_sec = kPatience.count(), .tv_usec = 0};
  setsockopt(link_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (process_ < 0) {
    close(link_);
    throw ChildError(fmt::format("{}: fork: {}", settings.command[0], std::strerror(error)));
  }
}

Child::~Child() {
  ending();
  close(link_);
}

std::optional<ChildRequest> Child::next() {
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
  if (size < static_cast<ssize_t>(sizeof request.head)) return std::nullopt;
  const std::size_t data_size = static_cast<std::size_t>(size) - sizeof request.head;
  request.data.assign(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(data_size));
  return request;
}

void Child::reply(std::int64_t value, int error, std::span<const std::byte> data) {
  shim::Reply head{.value = value, .error = error, .size = static_cast<std::uint32_t>(data.size())};
  std::array<iovec, 2> pieces{
      {{&head, sizeof head}, {const_cast<std::byte*>(data.data()), data.size()}}};
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  sendmsg(link_, &message, MSG_NOSIGNAL);  // a program that is gone is found by next()
}

std::string Child::ending() {
  if (process_ < 0) return "";
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
  const std::string said = last_line();
  return how_it_ended(ended_itself, status) + (said.empty() ? "" : ": " + said);
}

std::string Child::how_it_ended(bool itself, int status) const {
  if (was_too_slow_) return fmt::format("computed for {} s without waiting", kPatience.count());
  if (!itself) return "was ended";
  if (WIFSIGNALED(status)) {
    const char* name = sigabbrev_np(WTERMSIG(status));
    return fmt::format("was ended by signal {}", name != nullptr ? name : "?");
  }
  if (WEXITSTATUS(status) == kCannotRun) return "cannot be run";
  return fmt::format("exited with status {}", WEXITSTATUS(status));
}

std::string Child::last_line() const {
  std::ifstream log(log_);
  std::string line;
  std::string last;
  while (std::getline(log, line)) {
    if (!line.empty()) last = line;
  }
  constexpr std::size_t kMost = 200;
  return last.substr(0, kMost);
}

}  // namespace simbench::sim
