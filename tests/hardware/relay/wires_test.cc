// Which frames pass between the programs' hosts, and that they do, over real wires.
#include "hardware/relay/wires.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "hardware/experiment/child_process.h"
#include "hardware/relay/relayed_stream.h"
#include "recording/temporary_folder.h"
#include "scenarios/loader.h"
#include "tests/hardware/experiment/in_sandbox.h"

namespace simbench::hardware {
namespace {

constexpr std::size_t kMembers = 3;
constexpr std::uint32_t kFirst = 0x0A000001;

void put_word(Bytes& frame, std::size_t at, unsigned value) {
  frame[at] = static_cast<std::byte>(value >> 8U);
  frame[at + 1] = static_cast<std::byte>(value & 0xFFU);
}

void put_address(Bytes& frame, std::size_t at, std::uint32_t address) {
  put_word(frame, at, address >> 16U);
  put_word(frame, at + 2, address & 0xFFFFU);
}

Bytes datagram_to(std::uint32_t address) {
  Bytes frame(14 + 20 + 8 + 4);
  put_word(frame, 12, 0x0800);
  frame[14] = std::byte{0x45};
  frame[14 + 9] = std::byte{17};
  put_address(frame, 14 + 16, address);
  put_word(frame, 14 + 20 + 6, 0xABCD);
  return frame;
}

Bytes arp_for(std::uint32_t address) {
  Bytes frame(14 + 28);
  put_word(frame, 12, 0x0806);
  put_address(frame, 14 + 24, address);
  return frame;
}

TEST(Wires, ADatagramGoesToTheMemberOfItsAddress) {
  Bytes frame = datagram_to(kFirst + 2);
  const auto carried = look_at_frame(frame, kMembers);
  ASSERT_TRUE(carried);
  EXPECT_EQ(carried->kind, CarriedFrame::Kind::kDatagram);
  EXPECT_EQ(carried->to, 2U);
  EXPECT_EQ(frame[14 + 20 + 6], std::byte{0}) << "without its checksum";
  EXPECT_EQ(frame[14 + 20 + 7], std::byte{0});
}

TEST(Wires, OneToAGroupOrToAllGoesToAllOthers) {
  for (const std::uint32_t address : {0xE0000181U, 0xFFFFFFFFU, 0x0A00FFFFU}) {
    Bytes frame = datagram_to(address);
    const auto carried = look_at_frame(frame, kMembers);
    ASSERT_TRUE(carried) << address;
    EXPECT_FALSE(carried->to);
  }
}

TEST(Wires, AnAddressIsAskedForWhereItIs) {
  Bytes frame = arp_for(kFirst + 1);
  const auto carried = look_at_frame(frame, kMembers);
  ASSERT_TRUE(carried);
  EXPECT_EQ(carried->kind, CarriedFrame::Kind::kArp);
  EXPECT_EQ(carried->to, 1U);
}

TEST(Wires, NothingElsePasses) {
  const auto passes = [](Bytes frame) { return look_at_frame(frame, kMembers).has_value(); };
  EXPECT_FALSE(passes({}));
  EXPECT_FALSE(passes(datagram_to(kFirst + kMembers))) << "nobody's address";
  EXPECT_FALSE(passes(arp_for(kFirst + kMembers)));
  EXPECT_FALSE(passes(datagram_to(0x08080808)));
  Bytes tcp = datagram_to(kFirst);
  tcp[14 + 9] = std::byte{6};
  EXPECT_FALSE(passes(tcp));
  Bytes fragment = datagram_to(kFirst);
  put_word(fragment, 14 + 6, 0x2000);
  EXPECT_FALSE(passes(fragment));
  Bytes long_header = datagram_to(kFirst);
  long_header[14] = std::byte{0x4F};
  EXPECT_FALSE(passes(long_header)) << "a header longer than the frame";
  Bytes ipv6 = datagram_to(kFirst);
  put_word(ipv6, 12, 0x86DD);
  EXPECT_FALSE(passes(ipv6));
  const Bytes whole = datagram_to(kFirst);
  for (std::size_t size = 0; size < 14 + 20 + 8; ++size) {
    EXPECT_FALSE(passes(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))));
  }
}

// A member that sends a datagram to another and says how long the answer took, in ms.
constexpr const char* kAsk =
    "import socket, time\n"
    "link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
    "link.settimeout(10)\n"
    "for _ in range(3):\n"
    "    begin = time.monotonic()\n"
    "    link.sendto(b'?', ('10.0.0.1', 99))\n"
    "    link.recv(10)\n"
    "print(int(1000 * (time.monotonic() - begin)), flush=True)\n"
    "time.sleep(60)\n";
constexpr const char* kAnswer =
    "import socket\n"
    "link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
    "link.bind(('', 99))\n"
    "print('ready', flush=True)\n"
    "while True: link.sendto(b'!', link.recvfrom(10)[1])\n";

int round_trip_ms() {
  const TemporaryFolder folder;
  const auto member = [&](unsigned number, const char* script) {
    return std::make_unique<ChildProcess>(
        ChildProcess::Settings{.program = "/usr/bin/python3",
                               .arguments = {"-c", script},
                               .log = folder.file("log" + std::to_string(number)),
                               .sandbox_member = number,
                               .has_wire = true});
  };
  const MonotonicTime limit = monotonic_now() + std::chrono::seconds(20);
  const auto answering = member(0, kAnswer);
  answering->read_line(limit);
  const auto asking = member(1, kAsk);
  const scenarios::Scenario scenario = scenarios::load_scenario(
      "6node_relay", {{"/network/latency_fixed_ms", "20"}, {"/network/loss_probability", "0"}});
  boost::asio::io_context context;
  DelayQueue queue(context);
  Wires wires(context, queue,
              {.wires = {NetworkSandbox::wire(0), NetworkSandbox::wire(1)},
               .scenario = &scenario,
               .seed = 1});
  std::thread relay([&context] { context.run(); });
  const int took_ms = std::stoi(asking->read_line(limit));
  boost::asio::post(context, [&] {
    wires.stop();
    queue.stop();
  });
  relay.join();
  return took_ms;
}

TEST(Wires, ARoundTripTakesWhatTheNetworkTakes) {
  const int took_ms = in_sandbox(round_trip_ms);
  SKIP_WITHOUT_NAMESPACES(took_ms);
  EXPECT_GE(took_ms, 40);
  EXPECT_LT(took_ms, 76);
}

TEST(Wires, AWireThatIsNotThereIsNamed) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6node_relay");
  boost::asio::io_context context;
  DelayQueue queue(context);
  EXPECT_THROW(Wires(context, queue, {.wires = {"nowire"}, .scenario = &scenario, .seed = 1}),
               RelayError);
}

}  // namespace
}  // namespace simbench::hardware
