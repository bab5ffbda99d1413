#include "tests/hardware/node/node_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/free_port.h"

namespace simbench::hardware {
namespace {

constexpr int kReadyLimitMs = 20'000;

}  // namespace

NodeProcess::NodeProcess(std::filesystem::path folder)
    : folder_(std::move(folder)), port_(free_port()) {
  std::ofstream csv(folder_ / "played.csv");
  csv << "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  for (std::uint32_t i = 1; i <= kFrames; ++i) {
    const auto due_ms = (i - 1) * (kPeriod / std::chrono::milliseconds(1));
    csv << fmt::format("Depth,0,{},{},{}\n", i, due_ms + 5, due_ms);
  }
  std::string cameras;
  for (const char* serial : {"left", "middle", "right"}) {
    cameras +=
        fmt::format(R"({}{{"serial": "{}", "recording": "played.csv", "trigger_file": "trigger"}})",
                    cameras.empty() ? "" : ", ", serial);
  }
  std::ofstream(folder_ / "rig.json") << fmt::format(
      R"({{"schema_version": 1, "name": "killed", "trigger": "manual", "hosts": [
        {{"name": "host0", "address": "127.0.0.1", "port": {}, "cameras": [{}]}}]}})",
      port_, cameras);
}

NodeProcess::~NodeProcess() {
  if (process_ > 0) kill();
}

void NodeProcess::start() {
  int out[2];
  if (pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const std::string rig = folder_ / "rig.json";
  const std::string journals = folder_ / "journals";
  const std::string log = folder_ / "log";
  process_ = fork();
  if (process_ == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600), STDERR_FILENO);
    execl(SIMBENCH_PROGRAM, SIMBENCH_PROGRAM, "node", "--rig", rig.c_str(), "--name", "host0",
          "--journal", journals.c_str(), nullptr);
    _exit(127);
  }
  close(out[1]);
  pollfd readable = {out[0], POLLIN, 0};
  char first = 0;
  const bool ready = poll(&readable, 1, kReadyLimitMs) > 0 && read(out[0], &first, 1) == 1;
  close(out[0]);
  if (!ready) {
    std::stringstream said;
    said << std::ifstream(log).rdbuf();
    throw std::runtime_error(fmt::format("the node is not ready; it said: {}", said.str()));
  }
}

MonotonicTime NodeProcess::kill() {
  const MonotonicTime at = monotonic_now();
  ::kill(process_, SIGKILL);
  waitpid(std::exchange(process_, -1), nullptr, 0);
  return at;
}

void NodeProcess::set_trigger(MonotonicTime zero) const {
  const std::filesystem::path made = folder_ / "trigger.new";
  std::ofstream(made) << zero.time_since_epoch().count();
  std::filesystem::rename(made, folder_ / "trigger");
}

}  // namespace simbench::hardware
