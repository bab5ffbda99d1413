// The relay with real sockets on loopback, between two nodes that are plain sockets.
#include "hardware/relay/relay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <set>
#include <thread>

#include "hardware/net/wire.h"
#include "scenarios/loader.h"
#include "tests/free_port.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using testing::HasSubstr;

const boost::asio::ip::address kLoopback = boost::asio::ip::address_v4::loopback();

scenarios::Scenario scenario(const std::vector<scenarios::Override>& overrides = {}) {
  std::vector<scenarios::Override> all = {{"/network/latency_fixed_ms", "5"},
                                          {"/network/latency_exponential_ms", "0"},
                                          {"/network/spike_probability", "0"}};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scenarios::load_scenario("18cam_6host_45fps_lan", all);
}

// Two nodes, and a relay that runs in a thread of its own.
class RelayTest : public testing::Test {
 public:
  ~RelayTest() override { stop(); }

 protected:
  RelayTest() {
    for (int node = 0; node < 2; ++node) {
      Rig rig;
      rig.file = "node" + std::to_string(node) + ".json";
      for (int host = 0; host < 2; ++host) {
        rig.hosts.push_back({"host" + std::to_string(host), "127.0.0.1", free_port(), {}});
      }
      rigs_.push_back(rig);
    }
  }

  void start(scenarios::Scenario scenario) {
    scenario_ = std::move(scenario);
    scenario_.network.bandwidth_mbit_per_s = 0;
    relay_ = std::make_unique<Relay>(relay_context_, RelaySettings{rigs_, &scenario_, 1});
    thread_ = std::thread([this] { relay_context_.run(); });
  }
  void stop() {
    if (!thread_.joinable()) return;
    boost::asio::post(relay_context_, [this] { relay_->stop(); });
    thread_.join();
  }

  template <class Endpoint>
  Endpoint address(int node, int of_host) const {
    return Endpoint(
        kLoopback,
        rigs_[static_cast<std::size_t>(node)].hosts[static_cast<std::size_t>(of_host)].port);
  }
  // Where a node listens.
  udp::socket datagram_socket(int node) {
    udp::socket socket(context_, address<udp::endpoint>(node, node));
    const timeval limit{10, 0};
    setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    return socket;
  }
  static void limit_reads(tcp::socket& socket) {
    const timeval limit{10, 0};
    setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }

  std::vector<Rig> rigs_;
  scenarios::Scenario scenario_;
  boost::asio::io_context context_;
  boost::asio::io_context relay_context_;
  std::unique_ptr<Relay> relay_;
  std::thread thread_;
};

// Blocking, with the limit of the socket.
std::size_t read_datagram(udp::socket& socket, std::span<char> to, sockaddr_in* from = nullptr) {
  socklen_t size = from == nullptr ? 0 : sizeof *from;
  const ssize_t got =
      recvfrom(socket.native_handle(), to.data(), to.size(), 0, reinterpret_cast<sockaddr*>(from),
               from == nullptr ? nullptr : &size);
  return got < 0 ? 0 : static_cast<std::size_t>(got);
}

TEST_F(RelayTest, DatagramsArriveOnceInOrderAndNeverTooEarly) {
  start(scenario());
  udp::socket near = datagram_socket(0);
  udp::socket far = datagram_socket(1);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const std::int64_t sent = monotonic_now().time_since_epoch().count();
    near.send_to(boost::asio::buffer(&sent, sizeof sent), address<udp::endpoint>(0, 1));
    std::int64_t received = 0;
    ASSERT_EQ(read_datagram(far, std::span(reinterpret_cast<char*>(&received), sizeof received)),
              sizeof received);
    EXPECT_EQ(received, sent);
    EXPECT_GE(monotonic_now().time_since_epoch().count() - sent, 5'000'000);
  }
  stop();
  EXPECT_EQ(relay_->statistics().law.datagrams, 50u);
  EXPECT_GE(relay_->statistics().late_p50.value(), Nanoseconds(0));
  EXPECT_THAT(statistics_json(relay_->statistics()), HasSubstr(R"("datagrams":50,"lost":0)"));
}

TEST_F(RelayTest, AnAnswerGoesBackToWhereADatagramCameFrom) {
  start(scenario());
  udp::socket near = datagram_socket(0);
  udp::socket far = datagram_socket(1);
  near.send_to(boost::asio::buffer("ask", 3), address<udp::endpoint>(0, 1));
  char buffer[8] = {};
  sockaddr_in from{};
  ASSERT_EQ(read_datagram(far, buffer, &from), 3u);
  EXPECT_EQ(ntohs(from.sin_port), rigs_[1].hosts[0].port) << "node 1's address of node 0";
  far.send_to(boost::asio::buffer("tell", 4), address<udp::endpoint>(1, 0));
  ASSERT_EQ(read_datagram(near, buffer, &from), 4u);
  EXPECT_EQ(std::string(buffer, 4), "tell");
  EXPECT_EQ(ntohs(from.sin_port), rigs_[0].hosts[1].port) << "node 0's address of node 1";
}

TEST_F(RelayTest, LostDatagramsAreCountedAndTheOthersArrive) {
  start(scenario({{"/network/loss_probability", "0.3"}}));
  udp::socket near = datagram_socket(0);
  udp::socket far = datagram_socket(1);
  for (std::uint32_t i = 0; i < 200; ++i) {
    near.send_to(boost::asio::buffer(&i, sizeof i), address<udp::endpoint>(0, 1));
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  const timeval limit{0, 300'000};
  setsockopt(far.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  std::set<std::uint32_t> arrived;
  for (std::uint32_t i = 0; read_datagram(far, {reinterpret_cast<char*>(&i), sizeof i}) > 0;) {
    arrived.insert(i);
  }
  stop();
  EXPECT_EQ(arrived.size() + relay_->statistics().law.lost, 200u);
  EXPECT_GT(relay_->statistics().law.lost, 20u);
  EXPECT_LT(relay_->statistics().law.lost, 100u);
}

Bytes framed(std::size_t text_bytes, unsigned char fill) {
  const FrameHeader header = frame_header(text_bytes);
  Bytes all(header.begin(), header.end());
  all.resize(all.size() + text_bytes + kSealBytes, std::byte{fill});
  return all;
}

TEST_F(RelayTest, AStreamIsRelayedWholeBothWays) {
  start(scenario());
  tcp::acceptor acceptor(context_, address<tcp::endpoint>(0, 0));
  tcp::socket near(context_);
  near.connect(address<tcp::endpoint>(1, 0));
  tcp::socket far = acceptor.accept();
  limit_reads(near);
  limit_reads(far);
  Bytes sent(kHelloBytes, std::byte{7});
  for (const std::size_t size : {0u, 1u, 100u, 200'000u, 3u}) {
    const Bytes next = framed(size, static_cast<unsigned char>(size));
    sent.insert(sent.end(), next.begin(), next.end());
  }
  for (const auto& [from, to] : {std::pair(&near, &far), std::pair(&far, &near)}) {
    const MonotonicTime begin = monotonic_now();
    std::thread writer(
        [&, socket = from] { boost::asio::write(*socket, boost::asio::buffer(sent)); });
    Bytes received(sent.size());
    boost::asio::read(*to, boost::asio::buffer(received));
    writer.join();
    EXPECT_EQ(received, sent);
    EXPECT_GE(monotonic_now() - begin, from_ms(5));
  }
  near.close();
  char last = 0;
  boost::system::error_code error;
  far.read_some(boost::asio::buffer(&last, 1), error);
  EXPECT_TRUE(error) << "the end travels too";
  stop();
  EXPECT_EQ(relay_->statistics().streams, 1u);
  EXPECT_EQ(relay_->statistics().broken_streams, 0u);
  EXPECT_EQ(relay_->statistics().law.stream_messages, 13u);
}

TEST_F(RelayTest, WhatIsNoStreamIsCut) {
  start(scenario());
  tcp::acceptor acceptor(context_, address<tcp::endpoint>(0, 0));
  tcp::socket near(context_);
  near.connect(address<tcp::endpoint>(1, 0));
  tcp::socket far = acceptor.accept();
  limit_reads(near);
  boost::asio::write(near, boost::asio::buffer(std::string(4096, '\xff')));
  char last = 0;
  boost::system::error_code error;
  near.read_some(boost::asio::buffer(&last, 1), error);
  EXPECT_TRUE(error);
  stop();
  EXPECT_EQ(relay_->statistics().broken_streams, 1u);
}

TEST_F(RelayTest, WithoutTheOtherNodeAConnectionIsClosed) {
  start(scenario());
  tcp::socket near(context_);
  near.connect(address<tcp::endpoint>(1, 0));
  limit_reads(near);
  char last = 0;
  boost::system::error_code error;
  near.read_some(boost::asio::buffer(&last, 1), error);
  EXPECT_TRUE(error);
}

TEST_F(RelayTest, AFloodIsCutToItsRate) {
  start(scenario());
  const MonotonicTime begin = monotonic_now();
  udp::socket near = datagram_socket(0);
  constexpr int kFlood = 60'000;  // three seconds' worth, sent in much less
  const char byte = 1;
  for (int i = 0; i < kFlood; ++i) {
    near.send_to(boost::asio::buffer(&byte, 1), address<udp::endpoint>(0, 1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  stop();
  const RelayStatistics found = relay_->statistics();
  const double seconds = to_seconds(monotonic_now() - begin);
  EXPECT_GT(found.law.datagrams, 0u);
  EXPECT_LE(static_cast<double>(found.law.datagrams),
            (1 + seconds) * Relay::kMaxDatagramsPerSecond);
}

std::string refusal(const std::vector<Rig>& rigs) {
  boost::asio::io_context context;
  const scenarios::Scenario any = scenario();
  try {
    const Relay relay(context, {rigs, &any, 1});
  } catch (const RelayError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RelayTest, BadRigFilesAreOneLine) {
  std::vector<Rig> rigs = rigs_;
  rigs[1].hosts[0].address = "8.8.8.8";
  EXPECT_EQ(refusal(rigs),
            "node1.json: host 'host0': found address '8.8.8.8', allowed for a relay: a numeric "
            "loopback or private one");
  rigs = rigs_;
  rigs[0].hosts.pop_back();
  EXPECT_THAT(refusal(rigs), HasSubstr("node0.json: found 1 hosts, allowed: 2"));
  rigs = rigs_;
  rigs[1].hosts[0].port = rigs[0].hosts[1].port;
  EXPECT_THAT(refusal(rigs), HasSubstr("cannot listen on 127.0.0.1:"));
}

}  // namespace
}  // namespace simbench::hardware
