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
#include <map>
#include <thread>
#include <utility>

#include "processes/confinement.h"

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
  limit(RLIMIT_DATA, Child::kMostMemory);
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

// Programs of a package start each other by their names.
std::string search_path(const Child::Settings& settings) {
  const std::string& program =
      settings.program.empty() ? settings.command.front() : settings.program;
  const std::string folder = std::filesystem::path(program).parent_path().string();
  std::string path = "/usr/sbin:/usr/bin:/sbin:/bin";
  for (const char* each : {"/usr/sbin", "/usr/bin", "/sbin", "/bin"}) {
    if (folder == each) return path;
  }
  return folder.empty() ? path : folder + ":" + path;
}

std::vector<std::string> environment_of(const Child::Settings& settings) {
  std::map<std::string, std::string> all = {
      {"PATH", search_path(settings)}, {"TZ", "UTC0"}, {"LC_ALL", "C"}};
  for (const auto& [name, value] : settings.environment) all[name] = value;
  all["LD_PRELOAD"] = settings.shim;
  all[shim::kLinkVariable] = std::to_string(kLink);
  std::vector<std::string> environment;
  for (const auto& [name, value] : all) environment.push_back(fmt::format("{}={}", name, value));
  return environment;
}

}  // namespace

Child::Child(const Settings& settings)
    : name_(std::filesystem::path(settings.command.at(0)).filename()),
      log_(settings.folder + "/" + settings.log_name),
      patience_(settings.patience),
      served_(settings.served) {
  int link = settings.link;
  if (link < 0) {
    try {
      obstacle_ = start(settings, link);
    } catch (const ConfinementError& error) {
      obstacle_ = error.what();
    }
  }
  link_ = std::make_unique<ThreadLink>(link, patience_);
}

std::string Child::start(const Settings& settings, int& link) {
  std::vector<std::string> arguments = settings.command;
  std::vector<std::string> environment = environment_of(settings);
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const std::string& program =
      settings.program.empty() ? settings.command.front() : settings.program;
  Confinement confinement(settings.folder, settings.served);
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
  link = ends[0];
  return process_ < 0 ? fmt::format("no process: {}", std::strerror(error)) : "";
}

Child::~Child() { end(); }

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
  std::optional<ChildRequest> request = link_->next();
  has_asked_ |= request.has_value();
  return request;
}

void Child::reply(std::int64_t value, int error, std::span<const std::byte> data) {
  if (served_ == Served::kAll) follow_thread();
  link_->reply(value, error, data);
}

std::string Child::ending(const std::string& reason) {
  if (!obstacle_.empty()) return fmt::format("{}: {}", name_, obstacle_);
  const std::string how = end();
  const std::string said = last_line();
  return fmt::format("{}: {}{}", name_, reason.empty() ? how : reason,
                     said.empty() ? "" : ": " + said);
}

std::string Child::end() {
  if (process_ < 0) return "has closed its link";
  int status = 0;
  // One that has closed its link is exiting, and has a moment for it.
  pollfd link{.fd = link_->descriptor(), .events = 0, .revents = 0};
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
  if (link_->was_too_slow()) {
    return fmt::format("computed for {} s without waiting",
                       std::chrono::duration<double>(patience_).count());
  }
  if (!itself) return "was ended";
  if (WIFSIGNALED(status)) return signal_text(WTERMSIG(status));
  if (WEXITSTATUS(status) == kCannotRun && !has_asked_) return "cannot be run";
  return fmt::format("exited with status {}{}", WEXITSTATUS(status),
                     has_asked_ ? "" : ", and the preloaded library was never loaded");
}

// The log may be long, and need not have lines.
std::string Child::last_line() const {
  constexpr std::streamoff kMost = 400;
  std::ifstream log(log_, std::ios::binary | std::ios::ate);
  if (!log) return "";
  const std::streamoff begin = std::max<std::streamoff>(0, log.tellg() - kMost);
  log.seekg(begin);
  std::string line;
  std::string last;
  while (std::getline(log, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace simbench::processes
