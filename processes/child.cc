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
#include <map>
#include <mutex>
#include <utility>

#include "processes/confinement.h"
#include "processes/lesser_user.h"
#include "processes/readable.h"
#include "recording/distrusted_folder.h"
#include "recording/text_fields.h"

namespace simbench::processes {
namespace {

// Its number in the child: programs use the first ones, and some close those that follow.
constexpr int kLink = 200;
constexpr int kCannotRun = 127;

// How often a program that computes for long is looked at.

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
  int folder;
  int log;
  int link;
  int clock_page;
  int group;  // the entrance to the run's control group; -1: none
  rlim_t cpu_s;
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

// A kernel before 5.11 does it for one at a time.
void close_at_exec() {
  constexpr int kFirst = 3;
  if (syscall(SYS_close_range, kFirst, ~0U, CLOSE_RANGE_CLOEXEC) == 0) return;
  rlimit own{};
  if (getrlimit(RLIMIT_NOFILE, &own) != 0) _exit(kCannotRun);
  for (int each = kFirst; static_cast<rlim_t>(each) < own.rlim_cur; ++each) {
    fcntl(each, F_SETFD, FD_CLOEXEC);
  }
}

// Neither signals nor descriptors of the parent's are inherited.
void forget_parent() {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (int each = 1; each < NSIG; ++each) signal(each, SIG_DFL);
  umask(S_IWGRP | S_IWOTH);
  close_at_exec();
}

void set_limits(rlim_t cpu_s) {
  // The signal at the first may be handled; after these seconds the kernel kills.
  constexpr rlim_t kAfterwards_s = 5;
  const rlimit cpu{.rlim_cur = cpu_s, .rlim_max = cpu_s + kAfterwards_s};
  setrlimit(RLIMIT_CPU, &cpu);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, Child::kMostOutput);
  limit(RLIMIT_DATA, Child::kMostMemory);
  limit(RLIMIT_AS, Child::kMostAddresses);
  limit(RLIMIT_STACK, Child::kMostStack);
  limit(RLIMIT_NOFILE, Child::kMostDescriptors);
  limit(RLIMIT_NPROC, RunUse::kMostProcesses);
}

[[noreturn]] void become(const Plan& plan, Confinement& confinement, pid_t parent) {
  // Where that is not allowed the other limits remain.
  if (const ssize_t entered = write(plan.group, "0", 1); entered < 0) errno = 0;
  forget_parent();
  personality(ADDR_NO_RANDOMIZE);
  setpgid(0, 0);  // Ctrl-C at the terminal is the parent's to handle
  if (fchdir(plan.folder) != 0) _exit(kCannotRun);
  const int input = open("/dev/null", O_RDONLY);
  if (input < 0 || dup2(input, 0) < 0 || dup2(plan.log, 1) < 0 || dup2(plan.log, 2) < 0) {
    _exit(kCannotRun);
  }
  if (dup2(plan.link, kLink) < 0) fail("link", errno);
  if (plan.clock_page >= 0 && dup2(plan.clock_page, shim::kClockPage) < 0) fail("clock", errno);
  if (const Confinement::Failure failure = confinement.apply(); failure.what != nullptr) {
    fail(failure.what, failure.error);
  }
  if (getppid() != parent) _exit(kCannotRun);  // before its death could be heard of
  set_limits(plan.cpu_s);
  execve(plan.program, plan.arguments, plan.environment);
  fail(plan.program, errno);
}

ReadableOf readable_of(const Child::Settings& settings, const std::string& program) {
  return {.program = program,
          .words = {settings.command.begin() + 1, settings.command.end()},
          .environment = settings.environment,
          .shim = settings.shim,
          .readable = settings.readable,
          .served = settings.served};
}

const std::string& program_of(const Child::Settings& settings) {
  return settings.program.empty() ? settings.command.front() : settings.program;
}

// In whole seconds, one at least.
rlim_t cpu_seconds(std::chrono::milliseconds patience) {
  const auto whole = std::chrono::ceil<std::chrono::seconds>(patience * Child::kMostCpu);
  return static_cast<rlim_t>(std::max<std::chrono::seconds::rep>(1, whole.count()));
}

// Programs of a package start each other by their names.
std::string search_path(const Child::Settings& settings) {
  const std::string folder = std::filesystem::path(program_of(settings)).parent_path().string();
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
  environment.reserve(all.size());
  for (const auto& [name, value] : all) environment.push_back(fmt::format("{}={}", name, value));
  return environment;
}

}  // namespace

std::string why_root(const Child::Settings& settings) {
  if (!is_root()) return "";
  std::vector<std::string> needed = needed_paths(readable_of(settings, program_of(settings)));
  needed.push_back(settings.folder);
  const std::string obstacle = obstacle_to_nobody(needed);
  if (obstacle.empty()) return "";
  return fmt::format("{} runs as root, without root's capabilities, and not as nobody: {}",
                     std::filesystem::path(settings.command.at(0)).filename().string(), obstacle);
}

void agree_on_user(std::vector<Child::Settings>& programs) {
  const auto stays = [](const Child::Settings& each) { return !why_root(each).empty(); };
  const bool as_nobody = is_root() && !std::ranges::any_of(programs, stays);
  for (Child::Settings& each : programs) {
    each.as_nobody = as_nobody;
    if (!as_nobody) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(each.folder)) {
      give_to_nobody(entry.path());
    }
  }
}

Child::Child(const Settings& settings)
    : name_(std::filesystem::path(settings.command.at(0)).filename()),
      patience_(settings.patience),
      use_(settings.use),
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

namespace {

// A program takes four, a sweep has many: as many as the system lets this process have.
void raise_own_descriptors() {
  rlimit own{};
  if (getrlimit(RLIMIT_NOFILE, &own) != 0) return;
  own.rlim_cur = own.rlim_max;
  setrlimit(RLIMIT_NOFILE, &own);
}

}  // namespace

std::string Child::start(const Settings& settings, int& link) {
  static std::once_flag raised;
  std::call_once(raised, raise_own_descriptors);
  std::vector<std::string> arguments = settings.command;
  std::vector<std::string> environment = environment_of(settings);
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const std::string& program = program_of(settings);
  const bool as_nobody = settings.as_nobody.value_or(is_root() && why_root(settings).empty());
  Confinement confinement({.folder = settings.folder,
                           .readable = readable_paths(readable_of(settings, program)),
                           .served = settings.served,
                           .as_nobody = as_nobody});
  const int folder = open_folder_in(AT_FDCWD, settings.folder.c_str());
  log_ = ProgramLog(folder, settings.log_name);
  if (log_.descriptor() < 0) {
    close(folder);
    return fmt::format("no {}: {}", settings.log_name, std::strerror(log_.error()));
  }
  if (as_nobody) {
    give_to_nobody(folder);
    give_to_nobody(log_.descriptor());
  }
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    close(folder);
    return fmt::format("no link: {}", std::strerror(errno));
  }
  const std::shared_ptr<RunUse> run = settings.run ? settings.run : std::make_shared<RunUse>();
  const Plan plan{.program = program.c_str(),
                  .arguments = argument_pointers.data(),
                  .environment = environment_pointers.data(),
                  .folder = folder,
                  .log = log_.descriptor(),
                  .link = ends[1],
                  .clock_page = settings.clock_page,
                  .group = run->group().entrance(),
                  .cpu_s = served_ == Served::kAll ? cpu_seconds(patience_) : RLIM_INFINITY};
  const std::filesystem::path& group = run->group().path();
  // The last of the run's wardens finds it empty.
  warden_ = Warden([&](pid_t parent) { become(plan, confinement, parent); },
                   [&group] { rmdir(group.c_str()); });
  close(ends[1]);
  link = ends[0];
  use_ = std::make_shared<ProgramUse>(folder, warden_.process(), settings.folder_limits, run);
  if (warden_.program() < 0) return fmt::format("no process: {}", std::strerror(warden_.error()));
  is_started_ = true;
  return "";
}

Child::~Child() { end(); }

void Child::follow_thread() {
  const int cpu = sched_getcpu();
  if (cpu == std::exchange(cpu_, cpu) || cpu < 0 || cpu >= CPU_SETSIZE) return;
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(cpu, &only);
  sched_setaffinity(warden_.program(), sizeof only, &only);  // without it all goes on, slower
}

bool Child::is_within_limits(std::chrono::steady_clock::duration waited) {
  using Seconds = std::chrono::duration<double>;
  const std::chrono::milliseconds most = kPatiencesInAll * patience_;
  if (waited >= patience_) {
    excess_ = fmt::format("computed for {} s without waiting", Seconds(patience_).count());
  } else if (served_ == Served::kAll && computed_ + waited > most + asked_ * kShare) {
    excess_ = fmt::format("computed for {} s in all, beside {} ms for each request",
                          Seconds(most).count(), kShare.count());
  } else if (use_ && (waited >= ThreadLink::kLook || asked_ % kLookEvery == 0)) {
    excess_ = use_->excess();
  }
  return excess_.empty();
}

std::optional<ChildRequest> Child::next(const std::function<bool()>& is_asleep) {
  if (!obstacle_.empty()) return std::nullopt;
  std::chrono::steady_clock::duration took{};
  std::optional<ChildRequest> request = link_->next(
      [&](std::chrono::steady_clock::duration waited) {
        took = waited;
        return is_within_limits(waited);
      },
      is_asleep);
  asked_ += request ? 1 : 0;
  computed_ += took;
  return request;
}

void Child::reply(std::int64_t value, int error, std::span<const std::byte> data) {
  if (served_ == Served::kAll) follow_thread();
  link_->reply(value, error, data);
}

std::string ProgramEnd::text() const {
  return fmt::format("{}: {}{}{}", program, how, last_words.empty() ? "" : ": ", last_words);
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

ProgramEnd Child::end_of(const std::string& reason) {
  ProgramEnd ended{.program = printable_name(name_)};
  if (!obstacle_.empty()) {
    ended.how = printable_name(obstacle_);
    return ended;
  }
  const std::string how = end();
  ended.how = printable_name(reason.empty() ? how : reason);
  if (reason.empty()) ended.status = exit_status_;
  ended.last_words = printable_name(cut(log_.last_line()));
  return ended;
}

std::string Child::end() {
  if (!is_started_) return excess_.empty() ? "has closed its link" : excess_;
  // One that has closed its link is exiting, and has a moment for it.
  pollfd link{.fd = link_->descriptor(), .events = 0, .revents = 0};
  const bool is_exiting = poll(&link, 1, 0) > 0;
  const std::optional<int> status =
      warden_.status(std::chrono::milliseconds(is_exiting && excess_.empty() ? 1000 : 0));
  if (excess_.empty() && use_) excess_ = use_->excess();
  const bool is_killed = status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL;
  if (excess_.empty() && is_killed && use_) excess_ = use_->excess_of_killed();
  if (excess_.empty() && status && WIFEXITED(*status)) exit_status_ = WEXITSTATUS(*status);
  use_.reset();
  warden_.end();
  is_started_ = false;
  return how_it_ended(status);
}

namespace {

std::string signal_text(int number) {
  switch (number) {
    case SIGXFSZ:
      return fmt::format("wrote more than {} MiB into a file", Child::kMostOutput >> 20U);
    case SIGXCPU:
      return "used the processor for longer than it may";
    case SIGSYS:
      return "made a system call that is not for programs of the simulated world";
    default:
      break;
  }
  const char* name = sigabbrev_np(number);
  return fmt::format("was ended by signal {}", name != nullptr ? name : std::to_string(number));
}

}  // namespace

std::string Child::how_it_ended(std::optional<int> status) const {
  if (!excess_.empty()) return excess_;
  if (!status) return "was ended";
  if (WIFSIGNALED(*status)) return signal_text(WTERMSIG(*status));
  if (WEXITSTATUS(*status) == kCannotRun && asked_ == 0) return "cannot be run";
  return fmt::format("exited with status {}{}", WEXITSTATUS(*status),
                     asked_ > 0 ? "" : ", and the preloaded library was never loaded");
}

}  // namespace simbench::processes
