#include "hardware/net/peer_network.h"

#include <gmock/gmock.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hardware/net/notice.h"
#include "tests/hardware/net/networks.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;
using Kind = StreamError::Kind;

constexpr Nanoseconds kBriefly = std::chrono::milliseconds(50);

constexpr std::array kAllTransports = {Transport::kStream, Transport::kDatagram,
                                       Transport::kAlignment};

std::string transport_name(const testing::TestParamInfo<Transport>& test) {
  constexpr std::array kNames = {"Stream", "Datagram", "Alignment"};
  return kNames[static_cast<std::size_t>(test.param)];
}

class AllTransports : public testing::TestWithParam<Transport> {};
INSTANTIATE_TEST_SUITE_P(PeerNetwork, AllTransports, testing::ValuesIn(kAllTransports),
                         transport_name);

TEST_P(AllTransports, CarryMessagesBetweenAllHosts) {
  Networks hosts(3);
  ASSERT_TRUE(hosts.connect());
  for (PeerId from = 0; from < 3; ++from) {
    for (PeerId to = 0; to < 3; ++to) {
      if (from == to) continue;
      const std::string text = std::to_string(from) + " to " + std::to_string(to);
      hosts.send(from, to, GetParam(), text);
      EXPECT_EQ(hosts.text(to, from, GetParam()), text);
    }
  }
}

TEST_P(AllTransports, ReachAHostByItsName) {
  Networks hosts(2, "localhost");
  ASSERT_TRUE(hosts.connect());
  for (PeerId from = 0; from < 2; ++from) {
    hosts.send(from, 1 - from, GetParam(), "by name");
    EXPECT_EQ(hosts.text(1 - from, from, GetParam()), "by name");
  }
}

TEST_P(AllTransports, KeepTheBoundsOfMessages) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  for (const char* text : {"one", "", "three"}) hosts.send(1, 0, GetParam(), text);
  EXPECT_EQ(hosts.text(0, 1, GetParam()), "one");
  EXPECT_EQ(hosts.text(0, 1, GetParam()), "");
  EXPECT_EQ(hosts.text(0, 1, GetParam()), "three");
}

TEST_P(AllTransports, DoNotMix) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  hosts.send(0, 1, GetParam(), "here");
  for (const Transport other : kAllTransports) {
    if (other == GetParam()) continue;
    EXPECT_EQ(hosts.receive(1, 0, other, kBriefly), std::nullopt);
  }
  EXPECT_EQ(hosts.text(1, 0, GetParam()), "here");
}

TEST_P(AllTransports, ReceiveNothingByTheDeadlineAndNotBefore) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  const SteadyTime deadline = hosts.clock.steady_now() + kBriefly;
  EXPECT_EQ(in_time(hosts.context, hosts.channel(0, 1, GetParam()).receive(deadline)),
            std::nullopt);
  EXPECT_GE(hosts.clock.steady_now(), deadline);
}

TEST_P(AllTransports, WhatWaitsIsReceivedAlsoAfterTheDeadline) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  hosts.send(0, 1, GetParam(), "waits");
  pass(hosts.context, 50);
  EXPECT_EQ(hosts.text(1, 0, GetParam(), -kBriefly), "waits");
}

TEST_P(AllTransports, AReceiveWithoutADeadlineWaits) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  Running receiving(hosts.context, hosts.channel(1, 0, GetParam()).receive(SteadyTime::max()));
  pass(hosts.context, 20);
  EXPECT_FALSE(receiving.done());
  hosts.send(0, 1, GetParam(), "at last");
  EXPECT_EQ(text_of(receiving.get()->bytes), "at last");
}

// On the scales of the node's clock, which PlainClock sets apart by hours.
TEST_P(AllTransports, StampsLieBetweenTheCallsOfSenderAndReceiver) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  for (int i = 0; i < 20; ++i) {
    const MonotonicTime before = monotonic_now();
    const MessageId id = hosts.send(0, 1, GetParam(), "stamp");
    const auto left = in_time(hosts.context, hosts.channel(0, 1, GetParam())
                                                 .transmit_stamp(id, hosts.clock.steady_now() +
                                                                         std::chrono::seconds(20)));
    const auto message = hosts.receive(1, 0, GetParam());
    const MonotonicTime after = monotonic_now();
    ASSERT_TRUE(left && message);
    EXPECT_LE(hosts.clock.system_at(before), *left);
    EXPECT_LE(*left, hosts.clock.system_at(after));
    EXPECT_LE(hosts.clock.system_at(before), message->received);
    EXPECT_LE(message->received, hosts.clock.system_at(after));
    EXPECT_LE(hosts.clock.steady_at(before), message->received_steady);
    EXPECT_LE(message->received_steady, hosts.clock.steady_at(after));
    EXPECT_EQ(message->received_hardware, std::nullopt);
  }
}

TEST_P(AllTransports, ThereAreNoHardwareStamps) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  const MessageId id = hosts.send(0, 1, GetParam(), "x");
  EXPECT_EQ(in_time(hosts.context,
                    hosts.channel(0, 1, GetParam()).hardware_transmit_stamp(id, SteadyTime::max())),
            std::nullopt);
}

TEST_P(AllTransports, AFullQueueLosesItsOldest) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  constexpr std::size_t kMore = 5;
  for (std::size_t i = 0; i < Inbox::kMaxMessages + kMore; ++i) {
    hosts.send(0, 1, GetParam(), std::to_string(i));
    // Datagrams: no more in the kernel than it keeps.
    if (i % 16 == 0) hosts.context.poll();
  }
  ASSERT_TRUE(
      until(hosts.context, [&] { return hosts.statistics(1).dropped_full_queue == kMore; }));
  EXPECT_EQ(hosts.text(1, 0, GetParam()), std::to_string(kMore));
}

TEST_P(AllTransports, ClearForgetsWhatWaits) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  hosts.send(0, 1, GetParam(), "of the last session");
  pass(hosts.context, 50);
  hosts.networks[1]->clear();
  hosts.send(0, 1, GetParam(), "of this one");
  EXPECT_EQ(hosts.text(1, 0, GetParam()), "of this one");
}

TEST_P(AllTransports, WorkAgainAfterAHostCameBack) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  hosts.networks[1].reset();
  ASSERT_TRUE(until(hosts.context, [&] { return !hosts.networks[0]->connected(1); }));
  hosts.start(1);
  ASSERT_TRUE(hosts.connect());
  EXPECT_EQ(hosts.statistics(0).reconnections, 1u);
  hosts.send(0, 1, GetParam(), "again");
  EXPECT_EQ(hosts.text(1, 0, GetParam()), "again");
  hosts.send(1, 0, GetParam(), "and back");
  EXPECT_EQ(hosts.text(0, 1, GetParam()), "and back");
}

TEST_P(AllTransports, TooLongAMessageIsRefused) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  const StreamError error =
      stream_error([&] { hosts.send(0, 1, GetParam(), std::string((64u << 10) + 1, 'x')); });
  EXPECT_EQ(error.kind(), Kind::kNotUnderstood);
  EXPECT_THAT(error.what(), HasSubstr("too long, allowed: 65"));
}

TEST_P(AllTransports, TheLongestMessageArrives) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  const std::string longest(GetParam() == Transport::kStream ? 65536 : 65478, 'x');
  hosts.send(0, 1, GetParam(), longest);
  EXPECT_EQ(hosts.text(1, 0, GetParam()), longest);
}

TEST_P(AllTransports, NothingIsSentToWhoIsNotThere) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  hosts.networks[1].reset();
  ASSERT_TRUE(until(hosts.context, [&] { return !hosts.networks[0]->connected(1); }));
  const MessageId id = hosts.send(0, 1, GetParam(), "lost");
  const auto left = in_time(
      hosts.context, hosts.channel(0, 1, GetParam())
                         .transmit_stamp(id, hosts.clock.steady_now() + std::chrono::seconds(20)));
  EXPECT_EQ(left.has_value(), GetParam() != Transport::kStream);
}

TEST_P(AllTransports, MayGoWhileChannelsAreWaitedFor) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  Running receiving(hosts.context, hosts.channel(1, 0, GetParam()).receive(SteadyTime::max()));
  pass(hosts.context, 10);
  hosts.networks[1].reset();
  EXPECT_EQ(receiving.get(), std::nullopt);
}

// A message that is sent while the link is made is not lost.
TEST(PeerNetwork, AStreamWaitsForItsLink) {
  Networks hosts(2);
  Running sending(hosts.context, hosts.channel(0, 1, Transport::kStream).send(bytes_of("early")));
  EXPECT_EQ(hosts.text(1, 0, Transport::kStream), "early");
  sending.get();
}

TEST(PeerNetwork, TheChannelIsTheSameEachTime) {
  Networks hosts(2);
  EXPECT_EQ(&hosts.channel(0, 1, Transport::kStream), &hosts.channel(0, 1, Transport::kStream));
  EXPECT_NE(&hosts.channel(0, 1, Transport::kStream), &hosts.channel(0, 1, Transport::kDatagram));
}

TEST(PeerNetwork, AConductorIsHandedOver) {
  Networks hosts(2);
  std::unique_ptr<SecureStream> conductor;
  hosts.networks[0]->on_conductor(
      [&](std::unique_ptr<SecureStream> stream) { conductor = std::move(stream); });
  const auto mine = in_time(
      hosts.context, SecureStream::connect(hosts.context, "127.0.0.1", hosts.networks[0]->port(),
                                           key_from_digit('7'), PeerName{}, soon()));
  ASSERT_TRUE(until(hosts.context, [&] { return conductor != nullptr; }));
  EXPECT_EQ(conductor->peer(), PeerName{PeerName::kConductor});
  in_time(hosts.context, mine->send(bytes_of("ping")));
  EXPECT_EQ(text_of(in_time(hosts.context, conductor->receive(soon())).bytes), "ping");
}

TEST(PeerNetwork, AHostOfAnotherKeyIsNotLetIn) {
  Networks hosts(1);
  hosts.networks.resize(2);
  hosts.start(0);
  hosts.start(1, key_from_digit('8'));
  ASSERT_TRUE(until(hosts.context, [&] { return hosts.statistics(0).refused_connections > 0; }));
  EXPECT_FALSE(hosts.networks[0]->connected(1));
  EXPECT_FALSE(hosts.networks[1]->connected(0));
}

TEST(PeerNetwork, AHostThatCannotBeIsNotLetIn) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  for (const std::uint32_t claimed : {0u, 2u, 70000u}) {
    const auto before = hosts.statistics(0).refused_connections;
    const auto stream = in_time(
        hosts.context, SecureStream::connect(hosts.context, "127.0.0.1", hosts.networks[0]->port(),
                                             key_from_digit('7'), PeerName{claimed}, soon()));
    EXPECT_EQ(stream_error([&] { in_time(hosts.context, stream->receive(soon())); }).kind(),
              Kind::kUnreachable);
    EXPECT_EQ(hosts.statistics(0).refused_connections, before + 1);
  }
}

TEST(PeerNetwork, AnAddressThatCannotBeListenedAtIsSaid) {
  boost::asio::io_context context;
  PlainClock clock;
  Networks hosts(1);
  const PeerNetworkSettings taken{
      .listen = {"127.0.0.1", hosts.networks[0]->port()}, .peers = {}, .key = {}};
  const StreamError error = stream_error([&] { PeerNetwork(context, taken, clock); });
  EXPECT_EQ(error.kind(), Kind::kUnreachable);
  EXPECT_THAT(error.what(), HasSubstr("cannot listen there: Address already in use"));
  const PeerNetworkSettings foreign{.listen = {"192.0.2.1", 0}, .peers = {}, .key = {}};
  EXPECT_EQ(stream_error([&] { PeerNetwork(context, foreign, clock); }).kind(), Kind::kWrongKey);
}

}  // namespace
}  // namespace simbench::hardware
