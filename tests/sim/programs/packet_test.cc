#include "sim/programs/packet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "shim/addresses.h"

namespace simbench::sim {
namespace {

const shim::Address kHere = shim::ipv4_address(0x0A000001, 5000);
const shim::Address kThere = shim::ipv4_address(0x0A000002, 6000);
const shim::Address kHere6{.host = shim::unique_local(1), .port = 5000, .family = AF_INET6};
const shim::Address kThere6{.host = shim::unique_local(2), .port = 6000, .family = AF_INET6};

WirePacket datagram(std::size_t size, bool is_ipv4 = true, std::uint32_t number = 1) {
  WirePacket packet{.head = {.number = number,
                             .from = is_ipv4 ? kHere : kHere6,
                             .to = is_ipv4 ? kThere : kThere6},
                    .payload = Bytes(size)};
  for (std::size_t i = 0; i < size; ++i) packet.payload[i] = static_cast<std::byte>(i * 7 >> 3);
  return packet;
}

double wire_bytes(const std::vector<WirePacket>& parts) {
  return std::accumulate(parts.begin(), parts.end(), 0.0, [](double sum, const WirePacket& each) {
    return sum + bytes_on_wire(each);
  });
}

TEST(WirePacketTest, TheHeadsAreCounted) {
  EXPECT_EQ(bytes_on_wire(datagram(48)), 48 + 8);
  EXPECT_EQ(bytes_on_wire(datagram(48, false)), 48 + 8 + 20);
  WirePacket refusal = datagram(48);
  refusal.head.kind = PacketKind::kRefusal;
  EXPECT_EQ(bytes_on_wire(refusal), 8 + 20 + 8 + 48) << "ICMP quotes the heads";
  WirePacket frame = datagram(44);
  frame.head.kind = PacketKind::kFrame;
  EXPECT_EQ(bytes_on_wire(frame), 46 - 20) << "padded, and without IPv4's head";
  frame.payload.resize(1500);
  EXPECT_EQ(bytes_on_wire(frame), 1500 - 20);
}

// As many as 1500 bytes need: 1480 behind IPv4's head, the first 8 of them UDP's; by IPv6 1448
// behind two heads.
TEST(WirePacketTest, LargeDatagramsLeaveInFragments) {
  const struct {
    std::size_t size;
    bool is_ipv4;
    std::size_t parts;
  } cases[] = {{1472, true, 1},    {1473, true, 2},    {2952, true, 2},  {2953, true, 3},
               {65'507, true, 45}, {1452, false, 1},   {1453, false, 2}, {2888, false, 2},
               {2889, false, 3},   {65'527, false, 46}};
  for (const auto& each : cases) {
    const std::vector<WirePacket> parts = fragments_of(datagram(each.size, each.is_ipv4));
    EXPECT_EQ(parts.size(), each.parts) << each.size;
    std::size_t payload = 0;
    for (const WirePacket& part : parts) payload += part.payload.size();
    EXPECT_EQ(payload, each.size);
    const double heads = each.is_ipv4 || each.parts == 1 ? 0 : 8;
    const double longer = each.is_ipv4 ? 0 : 20;
    EXPECT_EQ(wire_bytes(parts), static_cast<double>(each.size) + 8 +
                                     static_cast<double>(each.parts) * (heads + longer));
  }
}

TEST(WirePacketTest, AMessageCarriesAPacket) {
  const WirePacket packet = datagram(100);
  const std::optional<WirePacket> again = packet_of(to_message(packet));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->payload, packet.payload);
  EXPECT_EQ(again->head.to, packet.head.to);
  EXPECT_EQ(again->head.from, packet.head.from);
  EXPECT_FALSE(packet_of(Bytes(3)));
}

SteadyTime at_s(double seconds) { return SteadyTime(from_ms(1e3 * seconds)); }

TEST(ReassemblyTest, ADatagramIsWholeWithItsLastFragmentInAnyOrder) {
  for (const bool is_ipv4 : {true, false}) {
    std::vector<WirePacket> parts = fragments_of(datagram(20'000, is_ipv4));
    std::rotate(parts.begin(), parts.begin() + 3, parts.end());
    Reassembly reassembly;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      parts[i].system = static_cast<std::int64_t>(100 + i);
      parts[i].hardware = static_cast<std::int64_t>(500 + parts[i].head.begin);
      const std::optional<WirePacket> whole = reassembly.add(1, parts[i], at_s(1));
      EXPECT_FALSE(reassembly.add(2, parts[i], at_s(1)) && i + 1 < parts.size())
          << "of a host each";
      ASSERT_EQ(whole.has_value(), i + 1 == parts.size());
      if (!whole) continue;
      EXPECT_EQ(whole->payload, datagram(20'000).payload);
      EXPECT_EQ(whole->head.whole, 0U);
      EXPECT_EQ(whole->system, static_cast<std::int64_t>(100 + i)) << "the last's stamp";
      EXPECT_EQ(whole->hardware, 500) << "by the card the first's";
    }
  }
}

TEST(ReassemblyTest, OneThatIsLostLosesAll) {
  const std::vector<WirePacket> parts = fragments_of(datagram(20'000));
  for (std::size_t lost = 0; lost < parts.size(); ++lost) {
    Reassembly reassembly;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i == lost) continue;
      EXPECT_FALSE(reassembly.add(1, parts[i], at_s(1)));
    }
    EXPECT_FALSE(reassembly.add(1, parts[lost], at_s(32))) << "after 30 s it comes too late";
  }
}

TEST(ReassemblyTest, DuplicatesChangeNothing) {
  const std::vector<WirePacket> parts = fragments_of(datagram(3000));
  ASSERT_EQ(parts.size(), 3U);
  Reassembly reassembly;
  EXPECT_FALSE(reassembly.add(1, parts[0], at_s(1)));
  EXPECT_FALSE(reassembly.add(1, parts[0], at_s(1)));
  EXPECT_FALSE(reassembly.add(1, parts[1], at_s(1)));
  EXPECT_TRUE(reassembly.add(1, parts[2], at_s(1)));
}

TEST(ReassemblyTest, MoreThanItsRoomIsNotKept) {
  Reassembly reassembly;
  std::uint32_t number = 0;
  for (std::size_t bytes = 0; bytes + 60'000 <= Reassembly::kMostBytes; bytes += 60'000) {
    reassembly.add(1, fragments_of(datagram(60'000, true, ++number)).front(), at_s(1));
  }
  std::vector<WirePacket> parts = fragments_of(datagram(60'000, true, ++number));
  for (const WirePacket& part : parts) EXPECT_FALSE(reassembly.add(1, part, at_s(1)));
  parts = fragments_of(datagram(60'000, true, ++number));
  bool is_whole = false;
  for (const WirePacket& part : parts) is_whole = reassembly.add(1, part, at_s(40)).has_value();
  EXPECT_TRUE(is_whole) << "once the old are forgotten";
}

}  // namespace
}  // namespace simbench::sim
