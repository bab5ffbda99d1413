// Programs that run twice, on the machine's own kernel and in the simulated world, where every call
// must give the same: the loopback's sockets.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::IsEmpty;

std::vector<std::string> said_lines(std::istream&& text) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::string path_of(const std::string& program) {
  return std::string(SIMBENCH_PROGRAMS) + "/simbench_" + program;
}

// A network of its own, whose loopback is up; the machine's where that is not allowed.
void leave_network() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return;
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP;
  ioctl(fd, SIOCSIFFLAGS, &loopback);
  close(fd);
}

bool has_ipv6() {
  const int fd = socket(AF_INET6, SOCK_DGRAM, 0);
  sockaddr_in6 loopback{};
  loopback.sin6_family = AF_INET6;
  loopback.sin6_addr = in6addr_loopback;
  const int result = bind(fd, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback);
  close(fd);
  return result == 0;
}

// What the program says on this machine; nothing if that has no IPv6.
std::vector<std::string> on_machine(const std::string& program) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  const std::string path = path_of(program);
  const pid_t child = fork();
  if (child == 0) {
    leave_network();
    if (!has_ipv6()) _exit(0);
    dup2(ends[1], STDOUT_FILENO);
    execl(path.c_str(), path.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  std::string said;
  std::array<char, 4096> bytes{};
  for (ssize_t size = 0; (size = read(ends[0], bytes.data(), bytes.size())) > 0;) {
    said.append(bytes.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << program;
  return said_lines(std::istringstream(said));
}

std::vector<std::string> in_world(const std::string& program) {
  const std::string folder = testing::TempDir() + "/twins_" + program;
  std::filesystem::remove_all(folder);
  ProgramSync sync({.pipeline = "test",
                    .programs = {.master = {{path_of(program)}}, .slave = {{"/bin/true"}}},
                    .shim = SIMBENCH_SHIM,
                    .log_folder = folder,
                    .hosts = 2});
  ServiceWorld world(
      scenarios::load_scenario("6host_star", {{"/hosts/count", "2"}, {"/cameras/count", "2"}}));
  world.start(sync);
  world.run_until(60);
  std::vector<std::string> said = said_lines(
      std::ifstream(fmt::format("{}/test/seed1/host0/0_simbench_{}.log", folder, program)));
  std::filesystem::remove_all(folder);
  return said;
}

class Twins : public testing::TestWithParam<const char*> {};

TEST_P(Twins, SayTheSame) {
  const std::vector<std::string> machine = on_machine(GetParam());
  const std::vector<std::string> world = in_world(GetParam());
  if (machine.empty()) GTEST_SKIP() << "the machine has no IPv6";
  if (machine.front() == "raw: EPERM") GTEST_SKIP() << "packet sockets are root's here";
  ASSERT_GT(machine.size(), 50U) << "the program has run";
  for (std::size_t i = 0; i < std::min(machine.size(), world.size()); ++i) {
    EXPECT_EQ(world[i], machine[i])
        << "line " << i + 1 << ", after \"" << machine[i == 0 ? 0 : i - 1] << "\"";
  }
  EXPECT_EQ(world.size(), machine.size());
}

INSTANTIATE_TEST_SUITE_P(Loopback, Twins,
                         testing::Values("twin_datagrams", "twin_descriptors", "twin_options",
                                         "twin_packets", "twin_streams"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace simbench::sim
