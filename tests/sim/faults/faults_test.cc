#include "sim/faults/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "sim/network/network.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

TEST(Outages, CountFromTheStartOfTheCapture) {
  Outages outages({scenarios::HostStops{.host = 2, .at_ms = 100, .duration_ms = 50},
                   scenarios::LinkStops{.host = 3, .at_ms = 100, .duration_ms = 50}});
  EXPECT_FALSE(outages.host_stopped(2, at_ms(120)));
  outages.start(at_ms(1000));
  EXPECT_FALSE(outages.host_stopped(2, at_ms(1099)));
  EXPECT_TRUE(outages.host_stopped(2, at_ms(1100)));
  EXPECT_FALSE(outages.host_stopped(2, at_ms(1150)));
  EXPECT_TRUE(outages.unreachable(2, at_ms(1120)));
  EXPECT_TRUE(outages.unreachable(3, at_ms(1120)));
  EXPECT_FALSE(outages.host_stopped(3, at_ms(1120))) << "only its link";
  EXPECT_FALSE(outages.unreachable(1, at_ms(1120)));
  Outages other({scenarios::CameraVanishes{.camera = 2, .at_ms = 0, .duration_ms = 50}});
  other.start(at_ms(0));
  EXPECT_FALSE(other.unreachable(2, at_ms(10)));
}

struct PathEnd final : Endpoint {
  PathEnd(SimNetwork& net, PeerId from, PeerId to, Transport transport)
      : network(net), path(net.open(from, to, transport, *this)) {}
  void on_arrival() override {
    for (const ArrivedMessage& message : network.inbox(path)) {
      ids.push_back(message.id);
      arrived_ms.push_back(to_ms(message.at.time_since_epoch()));
    }
    network.inbox(path).clear();
  }
  void on_left(MessageId, std::size_t, const HostDeparture&) override {}

  SimNetwork& network;
  PathId path;
  MessageId next = 0;
  std::vector<MessageId> ids;
  std::vector<double> arrived_ms;
};

// A message every 10 ms for a second over a link of 1 ms, one end of which stops from 300 to 500
// ms.
struct Talk {
  explicit Talk(Transport transport, PeerId from, PeerId to, bool nagle = false) {
    parameters.latency_fixed_ms = 1;
    parameters.retransmit_timeout_ms = 80;
    parameters.nagle = nagle;
    Engine engine;
    Outages outages({scenarios::LinkStops{.host = 1, .at_ms = 300, .duration_ms = 200}});
    outages.start(TrueTime{});
    const RunLoad load(1, "load", scenarios::Hosts{}, parameters);
    SimNetwork network(engine, parameters, 1, 3, load, outages);
    PathEnd here(network, from, to, transport);
    PathEnd there(network, to, from, transport);
    for (int i = 0; i < 100; ++i) {
      engine.call_at(at_ms(10 * i), [&] { network.send(here.path, here.next++, Bytes(1)); });
    }
    engine.run();
    ids = there.ids;
    arrived_ms = there.arrived_ms;
  }
  scenarios::Network parameters{};
  std::vector<MessageId> ids;
  std::vector<double> arrived_ms;
};

TEST(Outages, DatagramsToOrFromAStoppedLinkAreLost) {
  for (const auto& [from, to] : {std::pair<PeerId, PeerId>{0, 1}, {1, 0}}) {
    const Talk talk(Transport::kDatagram, from, to);
    ASSERT_EQ(talk.ids.size(), 80u);
    EXPECT_EQ(talk.ids[29], 29u);
    EXPECT_EQ(talk.ids[30], 50u);
  }
  EXPECT_EQ(Talk(Transport::kDatagram, 0, 2).ids.size(), 100u) << "others talk on";
}

TEST(Outages, StreamsRetransmit) {
  const Talk talk(Transport::kStream, 0, 1);
  ASSERT_EQ(talk.ids.size(), 100u);
  double last_ms = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    // Sent again after 80 ms, and after another 160 ms; arrives in order.
    double sent_ms = 10 * static_cast<double>(i);
    for (double timeout_ms = 80; sent_ms + 1 >= 300 && sent_ms < 500; timeout_ms *= 2) {
      sent_ms += timeout_ms;
    }
    last_ms = std::max(last_ms, sent_ms + 1);
    EXPECT_EQ(talk.ids[i], i);
    EXPECT_NEAR(talk.arrived_ms[i], last_ms, 1e-6) << i;
  }
}

// Its 15 retransmissions, after 80 ms doubled each time, span 80 ms * (2^15 - 1) = 2621.36 s.
TEST(Outages, AStreamBreaksOnALinkThatStaysDeadBeyondItsRetransmissions) {
  constexpr double kSpanMs = 80 * 32767;
  for (const auto& [transport, dead_ms, first, last] :
       {std::tuple{Transport::kStream, kSpanMs - 1, true, true},
        {Transport::kStream, kSpanMs + 1, false, false},
        {Transport::kDatagram, kSpanMs + 1, false, true}}) {
    scenarios::Network parameters{};
    parameters.retransmit_timeout_ms = 80;
    Engine engine;
    Outages outages({scenarios::LinkStops{.host = 1, .at_ms = 0, .duration_ms = dead_ms}});
    outages.start(TrueTime{});
    const RunLoad load(1, "load", scenarios::Hosts{}, parameters);
    SimNetwork network(engine, parameters, 1, 2, load, outages);
    PathEnd here(network, 0, 1, transport);
    PathEnd there(network, 1, 0, transport);
    // One while the link is dead, one long after it came back.
    for (const double ms : {0.0, 2 * kSpanMs}) {
      engine.call_at(at_ms(ms), [&] { network.send(here.path, here.next++, Bytes(1)); });
    }
    engine.run();
    EXPECT_EQ(std::count(there.ids.begin(), there.ids.end(), 0u), first) << dead_ms;
    EXPECT_EQ(std::count(there.ids.begin(), there.ids.end(), 1u), last) << dead_ms;
  }
}

TEST(Outages, NagleGoesOnWhenTheAcknowledgementsCanPassAgain) {
  for (const auto& [from, to] : {std::pair<PeerId, PeerId>{0, 1}, {1, 0}}) {
    const Talk talk(Transport::kStream, from, to, true);
    ASSERT_EQ(talk.ids.size(), 100u);
    for (const double ms : talk.arrived_ms) EXPECT_TRUE(ms < 300 || ms >= 500) << ms;
  }
}

}  // namespace
}  // namespace simbench::sim
