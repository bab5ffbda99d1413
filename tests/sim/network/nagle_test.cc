// Streams under Nagle's algorithm and delayed acknowledgements: mechanism H9 of
// docs/reference/calibration.md section 5.
#include "sim/network/nagle.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim/network/network.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

class NagleTest : public testing::Test {
 protected:
  class End : public Endpoint {
   public:
    End(SimNetwork& network, const Engine& engine, PeerId from, PeerId to)
        : network_(network), engine_(engine) {
      path_ = network.open(from, to, Transport::kStream, *this);
    }
    void send(std::size_t bytes) { network_.send(path_, next_++, Bytes(bytes)); }
    void on_arrival() override {
      for (const ArrivedMessage& message : network_.inbox(path_)) {
        arrivals_ms.push_back(ms_of(message.at));
      }
      network_.inbox(path_).clear();
      if (replies) send(8);
    }
    void on_left(MessageId, std::size_t count, const HostDeparture&) override {
      left_ms.insert(left_ms.end(), count, ms_of(engine_.now()));
    }

    bool replies = false;
    std::vector<double> arrivals_ms;
    std::vector<double> left_ms;

   private:
    SimNetwork& network_;
    const Engine& engine_;
    PathId path_ = 0;
    MessageId next_ = 0;
  };

  static scenarios::Network parameters(double delayed_ack_ms) {
    scenarios::Network network{};
    network.latency_fixed_ms = 1;
    network.retransmit_timeout_ms = 200;
    network.nagle = true;
    network.delayed_ack_ms = delayed_ack_ms;
    return network;
  }

  explicit NagleTest(double delayed_ack_ms = 200)
      : parameters_(parameters(delayed_ack_ms)),
        load_(1, "load", scenarios::Hosts{}, parameters_),
        network_(engine_, parameters_, 1, 2, load_, outages_),
        a_(network_, engine_, 0, 1),
        b_(network_, engine_, 1, 0) {}

  void send_at(double ms, End& end, std::size_t bytes = 8) {
    engine_.call_at(at_ms(ms), [&end, bytes] { end.send(bytes); });
  }

  scenarios::Network parameters_;
  Engine engine_;
  RunLoad load_;
  Outages outages_{std::vector<scenarios::Fault>{}};
  SimNetwork network_;
  End a_;
  End b_;
};

class NagleWithoutDelayTest : public NagleTest {
 protected:
  NagleWithoutDelayTest() : NagleTest(0) {}
};

// The signal leaves at once and the stamps wait for its acknowledgement, 200 ms delayed and 1 ms on
// the way; then they arrive together. Over n stamps this makes a spacing of 200 ms / n.
TEST(Nagle, AcknowledgementsArriveInOrderAlsoBeforeTrueZero) {
  Nagle stream(from_ms(40));
  EXPECT_EQ(stream.ack_in_order(at_ms(-1000)), at_ms(-1000));
  EXPECT_EQ(stream.ack_in_order(at_ms(-1001)), at_ms(-1000));
  EXPECT_EQ(stream.ack_in_order(at_ms(-990)), at_ms(-990));
}

TEST_F(NagleTest, StampsBehindASignalAreCoalescedByTheDelayedAcknowledgement) {
  send_at(0, a_);
  for (int i = 1; i <= 10; ++i) send_at(i * 0.01, a_);
  engine_.run();
  ASSERT_EQ(b_.arrivals_ms.size(), 11u);
  EXPECT_EQ(b_.arrivals_ms[0], 1);
  for (std::size_t i = 1; i <= 10; ++i) EXPECT_EQ(b_.arrivals_ms[i], 1 + 200 + 1 + 1);
  EXPECT_EQ(a_.left_ms[0], 0);
  EXPECT_EQ(a_.left_ms[10], 202);
}

TEST_F(NagleTest, AReplyCarriesTheAcknowledgementAtOnce) {
  b_.replies = true;
  send_at(0, a_);
  send_at(0.5, a_);
  engine_.run();
  // Reply and acknowledgement leave at 1 ms and reach host 0 at 2 ms, when the second one leaves.
  EXPECT_EQ(b_.arrivals_ms, (std::vector<double>{1, 3}));
}

TEST_F(NagleTest, AFullSegmentDoesNotWaitAndIsAcknowledgedAsTheSecond) {
  send_at(0, a_);
  send_at(1, a_, 1000);
  send_at(2, a_, 460);  // fills the segment
  send_at(3, a_);       // waits for the acknowledgement of both, sent at 3 ms
  engine_.run();
  EXPECT_EQ(b_.arrivals_ms, (std::vector<double>{1, 3, 3, 5}));
}

TEST_F(NagleTest, AMessageAfterTheAcknowledgementLeavesAtOnce) {
  send_at(0, a_);
  send_at(500, a_);
  engine_.run();
  EXPECT_EQ(b_.arrivals_ms, (std::vector<double>{1, 501}));
}

TEST_F(NagleTest, MessagesKeepTheirBoundaries) {
  send_at(0, a_, 3);
  send_at(1, a_, 5);
  send_at(2, a_, 7);
  engine_.run();
  EXPECT_EQ(b_.arrivals_ms.size(), 3u);
}

TEST_F(NagleTest, DirectionsAreIndependent) {
  send_at(0, a_);
  send_at(0, b_);
  send_at(0.5, b_);
  engine_.run();
  // Host 0 acknowledges host 1's first message only after the delay: it has nothing to send.
  EXPECT_EQ(a_.arrivals_ms, (std::vector<double>{1, 1 + 200 + 1 + 1}));
}

TEST_F(NagleWithoutDelayTest, StampsWaitForOneRoundTrip) {
  for (int i = 0; i < 5; ++i) send_at(i * 0.1, a_);
  engine_.run();
  EXPECT_EQ(b_.arrivals_ms, (std::vector<double>{1, 3, 3, 3, 3}));
}

}  // namespace
}  // namespace simbench::sim
