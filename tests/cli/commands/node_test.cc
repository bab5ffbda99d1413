// `simbench node` as a service manager starts and stops it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/cli/program.h"
#include "tests/free_port.h"

namespace simbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string csv() {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  for (int i = 0; i < 30; ++i) {
    text += "Depth,0," + std::to_string(i + 1) + "," + std::to_string(i * 33) + "," +
            std::to_string(i * 33) + "\n";
  }
  return text;
}

class NodeCommand : public ProgramTest {
 protected:
  NodeCommand() {
    file("played.csv", csv());
    file("rig.json", R"({"schema_version": 1, "name": "test", "hosts": [
      {"name": "host0", "address": "127.0.0.1", "port": )" +
                         std::to_string(port_) + R"(,
       "cameras": [{"serial": "left", "recording": "played.csv"}]},
      {"name": "host1", "address": "127.0.0.1", "port": 47111, "cameras": []}]})");
  }

  std::vector<std::string> node(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"node",  "--rig",     "rig.json", "--name",
                                          "host0", "--journal", "journals"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // Runs the node until it is ready, then sends `signal` and waits for the end (10 s).
  ProgramResult run_until_ready(const std::vector<std::string>& arguments, int signal) const {
    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) return {};
    const std::string err = folder() / "err";
    const pid_t process = fork();
    if (process == 0) {
      dup2(out[1], STDOUT_FILENO);
      dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      if (chdir(folder().c_str()) != 0) _exit(126);
      std::vector<std::string> words = {SIMBENCH_PROGRAM};
      words.insert(words.end(), arguments.begin(), arguments.end());
      std::vector<char*> argv;
      argv.reserve(words.size() + 1);
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      execv(SIMBENCH_PROGRAM, argv.data());
      _exit(127);
    }
    close(out[1]);
    ProgramResult result;
    pollfd readable = {out[0], POLLIN, 0};
    while (result.out.find('\n') == std::string::npos && poll(&readable, 1, 10'000) > 0) {
      char buffer[256];
      const ssize_t got = read(out[0], buffer, sizeof buffer);
      if (got <= 0) break;
      result.out.append(buffer, static_cast<std::size_t>(got));
    }
    close(out[0]);
    kill(process, signal);
    int status = 0;
    pid_t ended = 0;
    for (int i = 0; i < 1000 && ended == 0; ++i) {
      ended = waitpid(process, &status, WNOHANG);
      if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (ended == 0) {
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
    }
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.err = content("err");
    return result;
  }

  std::string ready_line() const {
    return "node host0: listening on 127.0.0.1:" + std::to_string(port_) + "\n";
  }

 private:
  int port_ = free_port();
};

TEST_F(NodeCommand, SaysWhenItIsReadyAndEndsWhenToldTo) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const ProgramResult result = run_until_ready(node(), signal);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, ready_line());
    EXPECT_THAT(result.err, HasSubstr("host0: 1 camera, journals in journals"));
    EXPECT_THAT(result.err, HasSubstr("stopping"));
  }
  const auto rights = std::filesystem::status(folder() / "journals").permissions();
  EXPECT_EQ(rights, std::filesystem::perms::owner_all);
}

TEST_F(NodeCommand, TakesAKeyAndAClockOfTests) {
  ASSERT_EQ(run({"keygen", "rig.key"}).status, 0);
  const ProgramResult result = run_until_ready(
      node({"--key-file", "rig.key", "--clock-offset-ms=-500", "--clock-skew-ppm=30"}), SIGTERM);
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(NodeCommand, AKeyThatOthersMayReadIsRefused) {
  using std::filesystem::perms;
  ASSERT_EQ(run({"keygen", "rig.key"}).status, 0);
  const perms readable_by_group = perms::owner_read | perms::owner_write | perms::group_read;
  std::filesystem::permissions(folder() / "rig.key", readable_by_group);
  const ProgramResult result = run(node({"--key-file", "rig.key"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("0640"), HasSubstr("chmod 600")));
}

TEST_F(NodeCommand, AnUnknownHostIsToldWhichThereAre) {
  std::vector<std::string> arguments = node();
  arguments[4] = "host7";
  const ProgramResult result = run(arguments);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("host7"), HasSubstr("host0"), HasSubstr("host1")));
}

TEST_F(NodeCommand, APortThatIsTakenIsOneLine) {
  const int taken = free_port();
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(taken));
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(server, 1), 0);
  file("rig.json", R"({"schema_version": 1, "name": "test", "hosts": [
    {"name": "host0", "address": "127.0.0.1", "port": )" +
                       std::to_string(taken) + R"(, "cameras": []}]})");
  const ProgramResult result = run(node());
  close(server);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr(std::to_string(taken))));
}

TEST_F(NodeCommand, ARecordingThatIsNotThereIsOneLine) {
  std::filesystem::remove(folder() / "played.csv");
  const ProgramResult result = run(node());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, AllOf(StartsWith("error: "), HasSubstr("played.csv")));
}

TEST_F(NodeCommand, AnAddressOfTheNetworkNeedsAKey) {
  file("rig.json", R"({"schema_version": 1, "name": "test", "hosts": [
    {"name": "host0", "address": "192.0.2.1", "cameras": []}]})");
  const ProgramResult result = run(node());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("192.0.2.1"));
}

TEST_F(NodeCommand, ClocksOfTestsAndTheSystemsExcludeEachOther) {
  const ProgramResult both = run(node({"--set-system-clock", "--clock-offset-ms=5"}));
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, AllOf(HasSubstr("--set-system-clock"), HasSubstr("--clock-offset-ms")));
  const ProgramResult alone = run(node({"--dry-run"}));
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("--set-system-clock"));
}

TEST_F(NodeCommand, HelpHasExamples) {
  const ProgramResult result = run({"node", "--help"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("--rig FILE"), HasSubstr("simbench node --rig rig.json"),
                                HasSubstr("Exit status")));
  EXPECT_THAT(result.err, IsEmpty());
}

}  // namespace
}  // namespace simbench
