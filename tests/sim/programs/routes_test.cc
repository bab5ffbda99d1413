#include "sim/programs/routes.h"

#include <gtest/gtest.h>

#include <cerrno>

#include "scenarios/loader.h"
#include "shim/addresses.h"
#include "sim/programs/cables.h"

namespace simbench::sim {
namespace {

using shim::Address;

Address by_ipv6(const shim::IpAddress& host, std::uint32_t scope = 0) {
  return {.host = host, .scope = scope, .port = 1, .family = AF_INET6};
}

shim::IpAddress group6(std::uint8_t scope) {
  shim::IpAddress group = shim::small_address(0x181);
  group.bytes[0] = 0xFF;
  group.bytes[1] = scope;
  return group;
}

TEST(RoutesTest, EachAddressHasOneOwner) {
  for (const AddressKind kind :
       {AddressKind::kIpv4, AddressKind::kUniqueLocal, AddressKind::kLinkLocal}) {
    for (const PeerId host : {0U, 1U, 5U, 299U, 1000U, 64'999U}) {
      const shim::IpAddress address = address_of(host, kind);
      EXPECT_EQ(owner_of(address, 65'000), host);
      EXPECT_EQ(kind_of(address), kind);
      EXPECT_FALSE(owner_of(address, host)) << "of a smaller network";
    }
  }
  EXPECT_FALSE(owner_of(shim::small_address(3), 10));
  EXPECT_FALSE(owner_of(shim::mapped(0xC0000201), 10));
}

// EUI-64 of 02:00:0a:00:01:02 is fe80::aff:fe00:102.
TEST(RoutesTest, TheLinksAddressIsThatOfTheCard) {
  std::uint8_t card[6] = {};
  shim::write_card_address(0x0A000102, 0, card);
  const shim::IpAddress address = shim::link_local(0x0A000102);
  EXPECT_EQ(address.bytes[8], card[0] ^ 2);
  EXPECT_EQ(address.bytes[9], card[1]);
  EXPECT_EQ(address.bytes[10], card[2]);
  EXPECT_EQ(address.bytes[11], 0xFF);
  EXPECT_EQ(address.bytes[12], 0xFE);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(address.bytes[13 + i], card[3 + i]);
}

TEST(RoutesTest, AnswersComeFromAnAddressOfTheSameReach) {
  const Routes routes(1, 4);
  const auto source = [&](const Address& to) { return routes.to(to, {}).source; };
  EXPECT_EQ(source(shim::ipv4_address(0x0A000001, 1)), shim::mapped(0x0A000002));
  EXPECT_EQ(source(by_ipv6(shim::unique_local(1))), shim::unique_local(2));
  EXPECT_EQ(source(by_ipv6(shim::link_local(0x0A000001), 2)), shim::link_local(0x0A000002));
  EXPECT_EQ(source(by_ipv6(group6(0x02))), shim::link_local(0x0A000002));
  EXPECT_EQ(source(by_ipv6(group6(0x0E))), shim::unique_local(2));
  EXPECT_EQ(source(by_ipv6(shim::kLoopback6)), shim::kLoopback6);
  EXPECT_EQ(source(shim::ipv4_address(0x7F000005, 1)), shim::mapped(0x7F000001));
}

TEST(RoutesTest, WhatNobodyHasIsUnreachable) {
  const Routes routes(1, 4);
  for (const Address& to :
       {shim::ipv4_address(0x0A000005, 1), shim::ipv4_address(0x08080808, 1),
        by_ipv6(shim::unique_local(5)), by_ipv6(shim::small_address(0x77)),
        by_ipv6(shim::link_local(0x0A000001), 1), by_ipv6(shim::link_local(0x0A000001), 3)}) {
    EXPECT_EQ(routes.to(to, {}).error, ENETUNREACH) << shim::number_in(to.host);
  }
  EXPECT_EQ(routes.to(shim::ipv4_address(0x0A000001, 1), {.interface = 1}).error, ENETUNREACH);
  const Address link = by_ipv6(shim::link_local(0x0A000001));
  EXPECT_EQ(routes.to(link, {}).error, 0);
  EXPECT_EQ(routes.to(link, {.must_name_link = true}).error, EINVAL);
  EXPECT_EQ(routes.to(link, {.interface = 2, .must_name_link = true}).error, 0);
}

TEST(RoutesTest, SocketsOfOnePortStandInEachOthersWay) {
  const shim::IpAddress any4 = shim::mapped(0);
  const shim::IpAddress own = shim::mapped(0x0A000002);
  EXPECT_TRUE(overlap({.host = {}}, {.host = any4}));
  EXPECT_TRUE(overlap({.host = own}, {.host = {}}));
  EXPECT_FALSE(overlap({.host = {}, .only_ipv6 = true}, {.host = own}));
  EXPECT_FALSE(overlap({.host = own}, {.host = {}, .only_ipv6 = true}));
  EXPECT_TRUE(overlap({.host = {}, .only_ipv6 = true}, {.host = shim::unique_local(2)}));
  EXPECT_TRUE(overlap({.host = any4}, {.host = own}));
  EXPECT_FALSE(overlap({.host = own}, {.host = shim::mapped(0x7F000001)}));
  EXPECT_FALSE(overlap({.host = any4}, {.host = shim::unique_local(2)}));
  EXPECT_FALSE(overlap({.host = any4, .interface = 1}, {.host = any4, .interface = 2}));
  EXPECT_TRUE(overlap({.host = any4, .interface = 1}, {.host = any4}));
}

TEST(CablesTest, AChainOfTimeAwareStationsHasACardForEachNeighbour) {
  const scenarios::Scenario chain = scenarios::load_scenario("4host_gptp_chain");
  const auto cables = [&](PeerId host) { return Cables(chain.hosts, chain.network, host, 4); };
  for (const PeerId host : {0U, 1U, 2U, 3U}) EXPECT_EQ(cables(host).cards(), 2U);
  EXPECT_EQ(cables(0).neighbour(0), 1U);
  EXPECT_EQ(cables(0).neighbour(1), std::nullopt);
  EXPECT_EQ(cables(0).carriers(), 1U);
  EXPECT_EQ(cables(2).neighbour(0), 1U);
  EXPECT_EQ(cables(2).neighbour(1), 3U);
  EXPECT_EQ(cables(2).carriers(), 3U);
  EXPECT_EQ(cables(2).card_to(3), 1U);
  EXPECT_EQ(cables(2).card_to(0), std::nullopt);
}

TEST(CablesTest, ASwitchThatKnowsNoPtpHasNone) {
  const scenarios::Scenario chain = scenarios::load_scenario("4host_chain");
  const Cables cables(chain.hosts, chain.network, 1, 4);
  EXPECT_EQ(cables.cards(), 1U);
  EXPECT_EQ(cables.carriers(), 1U);
  EXPECT_EQ(cables.neighbour(0), std::nullopt);
}

TEST(CablesTest, AHostHasSixteenAtMost) {
  const scenarios::Scenario star =
      scenarios::load_scenario("6host_star", {{"/hosts/count", "40"},
                                              {"/cameras/count", "40"},
                                              {"/network/switch_clock", "\"transparent\""}});
  EXPECT_EQ(Cables(star.hosts, star.network, 0, 40).cards(), 16U);
  EXPECT_EQ(Cables(star.hosts, star.network, 0, 40).neighbour(15), 16U);
  EXPECT_EQ(Cables(star.hosts, star.network, 39, 40).neighbour(0), 0U);
  EXPECT_EQ(Cables(star.hosts, star.network, 0, 40).card_to(39), std::nullopt);
}

}  // namespace
}  // namespace simbench::sim
