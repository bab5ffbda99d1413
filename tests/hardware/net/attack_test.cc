// What strangers, other versions, recordings of earlier sessions and cut links can do: nothing but
// be refused, in one line.
#include <gmock/gmock.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hardware/net/datagram.h"
#include "hardware/net/wire.h"
#include "tests/hardware/net/networks.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using testing::HasSubstr;
using Kind = StreamError::Kind;

// How an accept ends for who sends these bytes and then, if asked to, closes.
StreamError accept_of(std::span<const std::byte> bytes, bool closes = false,
                      Nanoseconds patience = kPatience) {
  boost::asio::io_context context;
  Listener listener(context);
  Running accepted(context,
                   listener.accept(key_from_digit('7'), PeerName{0}, monotonic_now() + patience));
  tcp::socket plain = listener.plain_connect();
  boost::asio::write(plain, boost::asio::buffer(bytes.data(), bytes.size()));
  if (closes) plain.close();
  return stream_error([&] { accepted.get(); });
}

TEST(Handshake, WhatIsNoSimbenchIsNotUnderstood) {
  const StreamError error = accept_of(bytes_of("GET / HTTP/1.1\r\n\r\n"));
  EXPECT_EQ(error.kind(), Kind::kNotUnderstood);
  EXPECT_THAT(error.what(), testing::StartsWith("127.0.0.1:"));
  EXPECT_THAT(error.what(), HasSubstr("does not speak as a simbench node does"));
}

TEST(Handshake, AnotherVersionIsNamed) {
  Hello hello = fresh_hello(PeerName{1});
  hello.version = 513;
  const StreamError error = accept_of(write_hello(hello));
  EXPECT_EQ(error.kind(), Kind::kWrongVersion);
  EXPECT_THAT(error.what(), HasSubstr("speaks protocol 513, this one speaks 2;"));
}

TEST(Handshake, SilenceIsATimeout) {
  EXPECT_EQ(accept_of({}, false, std::chrono::milliseconds(30)).kind(), Kind::kTimeout);
  const auto hello = write_hello(fresh_hello(PeerName{1}));
  EXPECT_EQ(accept_of(std::span(hello).first(20), false, std::chrono::milliseconds(30)).kind(),
            Kind::kTimeout);
  EXPECT_EQ(accept_of(hello, false, std::chrono::milliseconds(30)).kind(), Kind::kTimeout);
}

TEST(Handshake, WhoHangsUpIsUnreachable) {
  EXPECT_EQ(accept_of({}, true).kind(), Kind::kUnreachable);
}

TEST(Handshake, AnInventedConfirmationIsAWrongKey) {
  const auto hello = write_hello(fresh_hello(PeerName{1}));
  Bytes bytes(hello.begin(), hello.end());
  bytes.resize(bytes.size() + 200);
  EXPECT_EQ(accept_of(bytes).kind(), Kind::kWrongKey);
}

TEST(Handshake, BothSidesSayThatTheKeysDiffer) {
  boost::asio::io_context context;
  Listener listener(context);
  Running accepted(context, listener.accept(key_from_digit('7'), PeerName{0}));
  Running connected(context, listener.connect(key_from_digit('8'), PeerName{1}));
  for (auto* side : {&accepted, &connected}) {
    const StreamError error = stream_error([&] { side->get(); });
    EXPECT_EQ(error.kind(), Kind::kWrongKey);
    EXPECT_THAT(error.what(), HasSubstr("use the same key file on all hosts"));
  }
}

TEST(Handshake, NobodyThereIsUnreachable) {
  boost::asio::io_context context;
  std::uint16_t port = 0;
  {
    const Listener closed(context);
    port = closed.port();
  }
  const StreamError error = stream_error([&] {
    in_time(context, SecureStream::connect(context, "127.0.0.1", port, {}, PeerName{}, soon()));
  });
  EXPECT_EQ(error.kind(), Kind::kUnreachable);
  EXPECT_THAT(error.what(), HasSubstr("no connection: Connection refused"));
}

// One's own words come back: the keys of the two directions differ.
TEST(Handshake, AMirrorDoesNotHoldTheKey) {
  boost::asio::io_context context;
  Listener listener(context);
  Running accepted(context, listener.accept(key_from_digit('7'), PeerName{0}));
  tcp::socket mirror = listener.plain_connect();
  until(context, [&] {
    std::array<std::byte, 512> words{};
    const std::size_t size = mirror.available();
    if (size > 0)
      boost::asio::write(mirror,
                         boost::asio::buffer(words, mirror.read_some(boost::asio::buffer(words))));
    return accepted.done();
  });
  EXPECT_EQ(stream_error([&] { accepted.get(); }).kind(), Kind::kWrongKey);
}

// A whole session as it went over the wire, both ways, with the bytes of the connecting side.
Bytes recorded_session(std::size_t flipped = ~std::size_t{0}) {
  boost::asio::io_context context;
  Listener to_victim(context);
  Listener to_relay(context);
  Running accepted(context, to_victim.accept(key_from_digit('7'), PeerName{0}));
  Running connected(context, to_relay.connect(key_from_digit('7'), PeerName{1}));
  context.poll();
  tcp::socket near = to_relay.plain_accept();
  tcp::socket far = to_victim.plain_connect();
  Bytes recorded;
  const auto forward = [&](tcp::socket& from, tcp::socket& to, Bytes* keep) {
    while (from.available() > 0) {
      Bytes piece(from.available());
      piece.resize(from.read_some(boost::asio::buffer(piece)));
      for (std::size_t i = 0; keep != nullptr && i < piece.size(); ++i) {
        if (keep->size() == flipped) piece[i] ^= std::byte{1};
        keep->push_back(piece[i]);
      }
      boost::asio::write(to, boost::asio::buffer(piece));
    }
  };
  const auto pass_on = [&] {
    forward(near, far, &recorded);
    forward(far, near, nullptr);
  };
  until(context, [&] {
    pass_on();
    return accepted.done();
  });
  const auto victim = accepted.get();
  until(context, [&] {
    pass_on();
    return connected.done();
  });
  const auto sender = connected.get();
  in_time(context, sender->send(bytes_of("set the clock")));
  Running receiving(context, victim->receive(soon()));
  until(context, [&] {
    pass_on();
    return receiving.done();
  });
  EXPECT_EQ(text_of(receiving.get().bytes), "set the clock");
  return recorded;
}

TEST(Handshake, ARecordedSessionIsNotAcceptedAgain) {
  const Bytes recorded = recorded_session();
  ASSERT_GT(recorded.size(), kHelloBytes + 2 * (kFrameHeaderBytes + kSealBytes));
  EXPECT_EQ(accept_of(recorded).kind(), Kind::kWrongKey);
}

TEST(Handshake, NoByteOfItMayDiffer) {
  const std::size_t size = recorded_session().size() - std::string("set the clock").size() -
                           kFrameHeaderBytes - kSealBytes;
  for (std::size_t i = 0; i < size; ++i) {
    EXPECT_THROW(recorded_session(i), StreamError) << i;
  }
}

TEST(Attack, SlowConnectionsDoNotKeepOthersOut) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  std::vector<tcp::socket> slow;
  for (int i = 0; i < 100; ++i) {
    slow.emplace_back(hosts.context);
    slow.back().connect({boost::asio::ip::make_address("127.0.0.1"), hosts.networks[0]->port()});
  }
  pass(hosts.context, 50);
  hosts.networks[1].reset();
  ASSERT_TRUE(until(hosts.context, [&] { return !hosts.networks[0]->connected(1); }));
  hosts.start(1);
  EXPECT_TRUE(hosts.connect());
  // All of them are refused in the end, the last ones for their time.
  EXPECT_TRUE(until(hosts.context, [&] { return hosts.statistics(0).refused_connections >= 100; }));
}

class Stranger {
 public:
  Stranger(boost::asio::io_context& context, std::uint16_t port)
      : socket_(context, udp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0)),
        to_(boost::asio::ip::make_address("127.0.0.1"), port) {}
  void send(const Bytes& bytes) { socket_.send_to(boost::asio::buffer(bytes), to_); }

 private:
  udp::socket socket_;
  udp::endpoint to_;
};

TEST(Attack, StrangeDatagramsAreRefusedAndCounted) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  const NetworkStatistics& counted = hosts.statistics(0);
  Stranger stranger(hosts.context, hosts.networks[0]->port());
  const KeyBytes invented{9};
  DatagramSession forger(1, invented, invented);
  stranger.send(forger.seal_next(bytes_of("forged")));
  stranger.send(Bytes(5));
  stranger.send(Bytes(60000));
  DatagramSession nobody(77, invented, invented);
  stranger.send(nobody.seal_next(bytes_of("from no host")));
  ASSERT_TRUE(until(hosts.context, [&] { return counted.datagrams_received == 4; }));
  EXPECT_EQ(counted.refused_forged, 1u);
  EXPECT_EQ(counted.refused_malformed, 3u);
  EXPECT_EQ(hosts.receive(0, 1, Transport::kDatagram, std::chrono::milliseconds(20)), std::nullopt);
}

// A host that holds the key and speaks of a channel that there is not.
TEST(Attack, ADatagramForNoChannelIsRefusedAndCounted) {
  Networks hosts(2);
  hosts.networks[1].reset();
  const std::uint16_t port = hosts.networks[0]->port();
  const auto stream =
      in_time(hosts.context, SecureStream::connect(hosts.context, "127.0.0.1", port,
                                                   key_from_digit('7'), PeerName{1}, soon()));
  ASSERT_TRUE(until(hosts.context, [&] { return hosts.networks[0]->connected(1); }));
  DatagramSession session(*stream, 1, 0);
  Stranger host(hosts.context, port);
  host.send(session.seal_next(Bytes{std::byte{2}, std::byte{'x'}}));
  host.send(session.seal_next({}));
  host.send(session.seal_next(with_channel(Transport::kAlignment, bytes_of("whole"))));
  EXPECT_EQ(hosts.text(0, 1, Transport::kAlignment), "whole");
  EXPECT_EQ(hosts.statistics(0).datagrams_received, 3u);
  EXPECT_EQ(hosts.statistics(0).refused_malformed, 2u);
}

TEST(Attack, AFloodIsRefusedAndWhatIsRealArrives) {
  Networks hosts(2);
  ASSERT_TRUE(hosts.connect());
  Stranger stranger(hosts.context, hosts.networks[0]->port());
  const KeyBytes invented{9};
  DatagramSession forger(1, invented, invented);
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 20; ++k) stranger.send(forger.seal_next(bytes_of("forged")));
    hosts.send(1, 0, Transport::kDatagram, std::to_string(i));
    ASSERT_EQ(hosts.text(0, 1, Transport::kDatagram), std::to_string(i));
  }
  const NetworkStatistics& counted = hosts.statistics(0);
  EXPECT_TRUE(until(hosts.context, [&] { return counted.datagrams_received == 2100; }));
  EXPECT_EQ(counted.refused_forged + counted.refused_rate, 2000u);
  EXPECT_GT(counted.refused_rate, 0u);
}

// Connections that never say a word come from 127.0.0.1, as the conductor's own does.
TEST(Attack, AFloodFromTheConductorsAddressDoesNotLockItOut) {
  Networks hosts(1);
  std::unique_ptr<SecureStream> admitted;
  hosts.networks[0]->on_conductor(
      [&](std::unique_ptr<SecureStream> stream) { admitted = std::move(stream); });
  const std::uint16_t port = hosts.networks[0]->port();
  std::vector<tcp::socket> flood;
  const auto connect_one = [&] {
    flood.emplace_back(hosts.context).connect({boost::asio::ip::make_address("127.0.0.1"), port});
    hosts.context.poll();
  };
  for (int i = 0; i < 400; ++i) connect_one();
  pass(hosts.context, 20);
  Running conductor(hosts.context, SecureStream::connect(hosts.context, "127.0.0.1", port,
                                                         key_from_digit('7'), PeerName{}, soon()));
  for (int i = 0; i < 20; ++i) connect_one();
  EXPECT_NE(conductor.get(), nullptr);
  EXPECT_TRUE(until(hosts.context, [&] { return admitted != nullptr; }));
  EXPECT_GE(hosts.statistics(0).refused_connections, 400U - 256U);
}

}  // namespace
}  // namespace simbench::hardware
