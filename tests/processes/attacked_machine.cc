#include "tests/processes/attacked_machine.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <thread>

#include "recording/distrusted_folder.h"

namespace simbench::processes {
namespace {

namespace fs = std::filesystem;

constexpr char kAbstractName[] = "\0simbench-test-abstract";

int listening(const sockaddr_un& name, std::size_t path_size) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path_size);
  if (bind(socket, reinterpret_cast<const sockaddr*>(&name), size) == 0) listen(socket, 1);
  return socket;
}

// Processes that have the word in their command line.
std::string processes_of(const std::string& word) {
  std::string found;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string command = content(entry.path() / "cmdline");
    if (command.find(word) != std::string::npos) found += "process " + name + "\n";
  }
  return found;
}

std::string describe(const fs::path& path) {
  struct stat status {};
  lstat(path.c_str(), &status);
  return fmt::format("{} {:o} {} {} {} {}\n", path.string(), status.st_mode, status.st_uid,
                     status.st_size, status.st_nlink, status.st_mtim.tv_nsec);
}

}  // namespace

double machines_clock_s() {
  timespec wall{};
  timespec steady{};
  clock_gettime(CLOCK_REALTIME, &wall);
  clock_gettime(CLOCK_MONOTONIC, &steady);
  return static_cast<double>(wall.tv_sec - steady.tv_sec) +
         1e-9 * static_cast<double>(wall.tv_nsec - steady.tv_nsec);
}

namespace {

// This world has one thread, which nobody wakes; all else is granted.
int refusal_of(shim::Call call) {
  switch (call) {
    case shim::Call::kNewThread:
    case shim::Call::kNewProcess:
      return EAGAIN;
    case shim::Call::kSignal:
    case shim::Call::kFindProcess:
      return ESRCH;
    case shim::Call::kWaitForWake:
      return ETIMEDOUT;
    default:
      return 0;
  }
}

}  // namespace

std::string ending_of(const Child::Settings& settings) {
  constexpr int kMostRequests = 100'000;  // of a program that never waits
  Child child(settings);
  std::string reason;
  for (int i = 0; i < kMostRequests; ++i) {
    const std::optional<ChildRequest> request = child.next();
    if (!request) break;
    if (request->head.call == shim::Call::kNote) {
      reason.assign(reinterpret_cast<const char*>(request->data.data()), request->data.size());
      break;
    }
    const shim::Identity identity{.process = 100, .parent = 1, .thread = 100};
    child.reply(0, refusal_of(request->head.call), std::as_bytes(std::span(&identity, 1)));
    if (request->passed >= 0) close(request->passed);
  }
  return child.ending(reason);
}

AttackedMachine::AttackedMachine() {
  chmod(folder_.path().c_str(), 0711);  // for nobody, whom root's programs become
  chmod(canary_.path().c_str(), 0777);
  chmod(canary_.write("file", "a secret").c_str(), 0666);
  fs::create_directory(canary_ / "sub");
  chmod((canary_ / "sub").c_str(), 0777);
  sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
  (canary_ / "socket").copy(name.sun_path, sizeof name.sun_path - 1);
  socket_ = listening(name, sizeof name.sun_path);
  chmod((canary_ / "socket").c_str(), 0600);
  sockaddr_un abstract{.sun_family = AF_UNIX, .sun_path = {}};
  std::copy_n(kAbstractName, sizeof kAbstractName - 1, abstract.sun_path);
  abstract_ = listening(abstract, sizeof kAbstractName - 1);
  clock_s_ = machines_clock_s();
  before_ = state();
}

AttackedMachine::~AttackedMachine() {
  close(socket_);
  close(abstract_);
}

Child::Settings AttackedMachine::settings(const Attack& attack) const {
  std::vector<std::string> command = {std::string(SIMBENCH_PROGRAMS) + "/simbench_" +
                                      attack.program};
  command.insert(command.end(), attack.words.begin(), attack.words.end());
  command.push_back((attack.passes_shim_by ? "/" : "") + canary());
  return {.command = std::move(command),
          .folder = folder_.path().string(),
          .log_name = "program0.log",
          .shim = SIMBENCH_SHIM,
          .readable = attack.readable,
          .patience = attack.patience,
          .folder_limits = attack.disk,
          .run = std::make_shared<RunUse>(attack.memory)};
}

Attacked AttackedMachine::run(const Attack& attack) const {
  const auto begin = std::chrono::steady_clock::now();
  Attacked result;
  result.ending = ending_of(settings(attack));
  result.took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string log = folder_ / "program0.log";
  if (fs::is_regular_file(fs::symlink_status(log))) result.output = content(log);
  return result;
}

std::string AttackedMachine::state() const {
  std::string text = content("/proc/sys/kernel/hostname");
  text += fmt::format("priority {}\n", getpriority(PRIO_PROCESS, 0));
  for (const auto resource : {RLIMIT_AS, RLIMIT_NPROC, RLIMIT_FSIZE, RLIMIT_CPU}) {
    rlimit own{};
    getrlimit(resource, &own);
    text += fmt::format("limit {} {}\n", own.rlim_cur, own.rlim_max);
  }
  text += describe(canary_.path()) + describe(canary_ / "sub") + describe(canary_ / "socket");
  text += describe(canary_ / "file") + canary_.content("file");
  return text;
}

std::string AttackedMachine::change() const {
  std::string left = processes_of(canary());
  for (int i = 0; i < 100 && !left.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    left = processes_of(canary());
  }
  if (!left.empty()) return left;
  if (std::abs(machines_clock_s() - clock_s_) > 0.1) return "the machine's clock";
  const std::string after = state();
  return after == before_ ? "" : fmt::format("before\n{}after\n{}", before_, after);
}

}  // namespace simbench::processes
