#include "hardware/experiment/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

#include "hardware/experiment/network_sandbox.h"
#include "scenarios/input_file.h"

namespace simbench::hardware {
namespace {

constexpr Nanoseconds kPatience = std::chrono::seconds(2);
constexpr int kCannotRun = 127;

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw ChildError("no pipe can be made");
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
  Descriptor read;
  Descriptor write;
};

// What the child needs between fork() and exec(), where only async-signal-safe calls are allowed.
struct Plan {
  const char* program = nullptr;
  char* const* arguments = nullptr;
  int log = -1;
  int output = -1;
  pid_t parent = 0;
  std::optional<unsigned> member{};
  bool has_wire = false;
  int left_hub = -1;   // the child writes a byte here when it has its namespace
  int connected = -1;  // and waits here until it is connected
};

[[noreturn]] void become(const Plan& plan) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != plan.parent) _exit(kCannotRun);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);  // Ctrl-C at the terminal is the parent's to handle
  if (plan.member) {
    char byte = 0;
    const bool connected = NetworkSandbox::leave_hub() && write(plan.left_hub, &byte, 1) == 1 &&
                           read(plan.connected, &byte, 1) == 1 &&
                           NetworkSandbox::set_up_member(*plan.member) &&
                           (!plan.has_wire || NetworkSandbox::set_up_wire(*plan.member));
    if (!connected) _exit(kCannotRun);
  }
  const int input = open("/dev/null", O_RDONLY);
  if (input < 0 || dup2(input, 0) < 0 || dup2(plan.output, 1) < 0 || dup2(plan.log, 2) < 0) {
    _exit(kCannotRun);
  }
  execv(plan.program, plan.arguments);
  _exit(kCannotRun);
}

std::string last_lines(const std::string& file) {
  constexpr std::size_t kLargestLog = std::size_t{16} << 20;
  std::string text;
  try {
    text = file_content(file, kLargestLog);
  } catch (const FileError& error) {
    return fmt::format("{}: cannot be read: {}", file, error.what());
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  constexpr std::size_t kMost = 400;
  if (text.size() > kMost) text.erase(0, text.size() - kMost);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

ChildProcess::ChildProcess(const Settings& settings)
    : name_(settings.arguments.empty() ? settings.program : settings.arguments.front()),
      log_(settings.log) {
  std::vector<char*> arguments = {const_cast<char*>(settings.program.c_str())};
  for (const auto* words : {&settings.leading, &settings.arguments}) {
    for (const std::string& each : *words) arguments.push_back(const_cast<char*>(each.c_str()));
  }
  arguments.push_back(nullptr);
  const Descriptor log(open(log_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  if (!log.good()) throw ChildError(fmt::format("{}: {}", log_, std::strerror(errno)));
  Pipe output;
  Pipe left_hub;
  Pipe connected;
  const Plan plan{.program = settings.program.c_str(),
                  .arguments = arguments.data(),
                  .log = log.number(),
                  .output = output.write.number(),
                  .parent = getpid(),
                  .member = settings.sandbox_member,
                  .has_wire = settings.has_wire,
                  .left_hub = left_hub.write.number(),
                  .connected = connected.read.number()};
  std::fflush(nullptr);  // else the child may write its copy of the buffers again
  process_ = fork();
  if (process_ == 0) become(plan);
  if (process_ < 0) throw ChildError(fmt::format("fork: {}", std::strerror(errno)));
  output_.reset(output.read.release());
  if (!settings.sandbox_member) return;
  left_hub.write.reset();
  char byte = 0;
  try {
    if (read(left_hub.read.number(), &byte, 1) != 1) fail("has no network namespace of its own");
    NetworkSandbox::connect(*settings.sandbox_member, process_);
    if (settings.has_wire) NetworkSandbox::connect_wire(*settings.sandbox_member, process_);
    if (write(connected.write.number(), &byte, 1) != 1) fail("ended at once");
  } catch (...) {
    end(Nanoseconds(0));
    throw;
  }
}

ChildProcess::~ChildProcess() { end(kPatience); }

void ChildProcess::fail(const std::string& problem) const {
  const std::string last = last_lines(log_);
  throw ChildError(
      fmt::format("simbench {}: {}{}{}", name_, problem, last.empty() ? "" : ": ", last));
}

bool ChildProcess::read_more(MonotonicTime deadline) {
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - monotonic_now());
    pollfd waits{output_.number(), POLLIN, 0};
    const int ready = poll(&waits, 1, std::max(0, static_cast<int>(left.count())));
    if (ready == 0) return false;
    if (ready < 0 && errno == EINTR) continue;
    std::array<char, 4096> buffer{};
    const ssize_t size = read(output_.number(), buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    read_.append(buffer.data(), static_cast<std::size_t>(size));
    return true;
  }
}

std::string ChildProcess::read_line(MonotonicTime deadline) {
  std::size_t end = 0;
  while ((end = read_.find('\n')) == std::string::npos) {
    if (!read_more(deadline)) {
      fail(monotonic_now() < deadline ? "ended before it was ready" : "was not ready in time");
    }
  }
  std::string line = read_.substr(0, end);
  read_.erase(0, end + 1);
  return line;
}

bool ChildProcess::collect(Nanoseconds patience) {
  const MonotonicTime deadline = monotonic_now() + patience;
  while (true) {
    const pid_t collected = waitpid(process_, nullptr, WNOHANG);
    if (collected == process_ || (collected < 0 && errno == ECHILD)) return true;
    if (monotonic_now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::string ChildProcess::end(Nanoseconds patience) {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    if (!collect(patience)) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    process_ = -1;
    while (read_more(monotonic_now())) {
    }
  }
  output_.reset();
  return std::exchange(read_, {});
}

}  // namespace simbench::hardware
