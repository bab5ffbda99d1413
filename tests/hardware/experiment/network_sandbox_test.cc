// Each test makes its namespaces in a process of its own, and everything is gone with that.
#include "hardware/experiment/network_sandbox.h"

#include <gtest/gtest.h>
#include <net/if.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <string>

#include "hardware/experiment/child_process.h"
#include "recording/temporary_folder.h"
#include "tests/hardware/experiment/in_sandbox.h"

namespace simbench::hardware {
namespace {

ChildProcess::Settings member(const TemporaryFolder& folder, unsigned number,
                              const std::string& script) {
  return {.program = "/bin/sh",
          .arguments = {"-c", script},
          .log = folder.file("log"),
          .sandbox_member = number};
}

TEST(NetworkSandbox, AddressesOfAPairShareASmallNetwork) {
  EXPECT_EQ(NetworkSandbox::hub_address(0), "10.77.0.1");
  EXPECT_EQ(NetworkSandbox::member_address(0), "10.77.0.2");
  EXPECT_EQ(NetworkSandbox::hub_address(5), "10.77.5.1");
}

TEST(NetworkSandbox, AMemberBeyondTheAddressesIsRefused) {
  EXPECT_THROW(NetworkSandbox::connect(NetworkSandbox::kMaxMembers, getpid()), SandboxError);
}

TEST(NetworkSandbox, NothingOfItIsSeenOutside) {
  const int result = in_sandbox([] {
    const TemporaryFolder folder;
    ChildProcess child(member(folder, 3, "echo ready; exec sleep 60"));
    child.read_line(monotonic_now() + std::chrono::seconds(20));
    return if_nametoindex("hub3") != 0 ? kGood : 1;
  });
  SKIP_WITHOUT_NAMESPACES(result);
  EXPECT_EQ(result, kGood);
  EXPECT_EQ(if_nametoindex("hub3"), 0u);
}

TEST(NetworkSandbox, MembersSeeTheirOwnInterfaceOnly) {
  const int result = in_sandbox([] {
    const TemporaryFolder folder;
    ChildProcess first(member(folder, 0, "cat /proc/net/dev | grep -c :; exec sleep 60"));
    ChildProcess second(member(folder, 1, "cat /proc/net/dev | grep -c :; exec sleep 60"));
    const MonotonicTime deadline = monotonic_now() + std::chrono::seconds(20);
    const int interfaces =
        std::stoi(first.read_line(deadline)) + std::stoi(second.read_line(deadline));
    return if_nametoindex("hub0") != 0 && if_nametoindex("hub1") != 0 ? interfaces : 50;
  });
  SKIP_WITHOUT_NAMESPACES(result);
  // lo and eth0 of each; kernels may have tunnels' fallback interfaces in every namespace.
  EXPECT_GE(result, 4);
  EXPECT_LT(result, 50);
}

TEST(NetworkSandbox, TheHubReachesAMemberAndANumberIsUsedAgain) {
  const int result = in_sandbox([] {
    using boost::asio::ip::udp;
    const TemporaryFolder folder;
    boost::asio::io_context context;
    for (int round = 0; round < 2; ++round) {
      ChildProcess child(member(folder, 2, "echo ready; exec sleep 60"));
      child.read_line(monotonic_now() + std::chrono::seconds(20));
      // Nobody listens there: that the port is refused says that the member answered.
      udp::socket socket(context, udp::v4());
      socket.connect({boost::asio::ip::make_address(NetworkSandbox::member_address(2)), 9});
      const timeval limit{10, 0};
      setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
      if (send(socket.native_handle(), "?", 1, 0) != 1) return 1;
      char answer = 0;
      if (recv(socket.native_handle(), &answer, 1, 0) >= 0 || errno != ECONNREFUSED) return 2;
    }
    return kGood;
  });
  SKIP_WITHOUT_NAMESPACES(result);
  EXPECT_EQ(result, kGood);
}

}  // namespace
}  // namespace simbench::hardware
