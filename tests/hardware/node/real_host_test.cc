// A real host's own promises: sleeping, the frame feed, what it puts on record, its channels.
#include "hardware/node/real_host.h"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "tests/hardware/await.h"
#include "tests/hardware/node/host_pair.h"

namespace simbench::hardware {
namespace {

class RealHostTest : public testing::Test {
 protected:
  boost::asio::io_context& context() { return pair.context(); }
  RealHost& host() { return pair.host(1); }

  HostPair pair{from_ms(300), 0, 30};
};

FrameArrival frame_of(std::uint32_t counter) {
  FrameArrival frame;
  frame.camera = 2;
  frame.counter = counter;
  return frame;
}

Task<void> sleep_until(Host& host, HostTime at, bool& woke) {
  co_await host.sleep_until(at);
  woke = true;
}

TEST_F(RealHostTest, HasNoCardClockAndNoPulses) {
  EXPECT_EQ(host().id(), 1u);
  EXPECT_EQ(host().hardware_clock(), nullptr);
  EXPECT_EQ(host().pulse_input(PulseLine::kPps), nullptr);
  EXPECT_EQ(host().pulse_input(PulseLine::kTrigger), nullptr);
  EXPECT_EQ(host().frame_feed(), host().frame_feed());
  EXPECT_EQ(&host().open_channel(0, Transport::kStream),
            &host().open_channel(0, Transport::kStream));
}

TEST_F(RealHostTest, ItsSteadyClockIsTheNodesOscillator) {
  const SteadyTime before = pair.clock(1).steady_at(monotonic_now());
  const SteadyTime reads = host().steady_clock().now();
  EXPECT_GE(reads, before);
  EXPECT_LE(reads, pair.clock(1).steady_at(monotonic_now()));
}

TEST_F(RealHostTest, SleepsForSteadyTime) {
  const SteadyTime before = host().steady_clock().now();
  await(context(), host().sleep_for(from_ms(20)));
  EXPECT_GE(host().steady_clock().now(), before + from_ms(20));
  await(context(), host().sleep_for(from_ms(-20)));
}

TEST_F(RealHostTest, SleepsUntilItsSystemClockReads) {
  const HostTime at = pair.clock(1).system_at(monotonic_now()) + from_ms(20);
  await(context(), host().sleep_until(at));
  EXPECT_GE(pair.clock(1).system_at(monotonic_now()), at);
  await(context(), host().sleep_until(at));
}

TEST_F(RealHostTest, AStepForwardEndsASleep) {
  bool woke = false;
  const HostTime at = pair.clock(1).system_at(monotonic_now()) + std::chrono::hours(1);
  boost::asio::co_spawn(context(), sleep_until(host(), at, woke), boost::asio::detached);
  await(context(), host().sleep_for(from_ms(5)));
  EXPECT_FALSE(woke);
  await(context(), host().clock().set(at));
  run_until(context(), [&] { return woke; });
}

TEST_F(RealHostTest, AStepBackwardProlongsASleep) {
  bool woke = false;
  const HostTime at = pair.clock(1).system_at(monotonic_now()) + from_ms(30);
  boost::asio::co_spawn(context(), sleep_until(host(), at, woke), boost::asio::detached);
  await(context(), host().sleep_for(from_ms(1)));
  await(context(), host().clock().set(at - std::chrono::hours(1)));
  await(context(), host().sleep_for(from_ms(60)));
  EXPECT_FALSE(woke);
  await(context(), host().clock().set(at));
  run_until(context(), [&] { return woke; });
}

TEST_F(RealHostTest, AChangeOfRateMovesTheEndOfASleep) {
  bool woke = false;
  const HostTime at = pair.clock(1).system_at(monotonic_now()) + from_ms(100);
  boost::asio::co_spawn(context(), sleep_until(host(), at, woke), boost::asio::detached);
  await(context(), host().clock().adjust_frequency(-4e8));
  run_until(context(), [&] { return woke; });
  EXPECT_GE(pair.clock(1).system_at(monotonic_now()), at);
}

TEST_F(RealHostTest, AReleasedClockIsTheNextObservers) {
  host().release_clock();
  int adjustments = 0;
  pair.clock(1).observe([&](const ClockAdjustment&) { ++adjustments; });
  host().release_clock();
  await(context(), pair.clock(1).adjust_frequency(5000));
  EXPECT_EQ(adjustments, 1);
  pair.clock(1).observe(nullptr);
}

TEST_F(RealHostTest, DrawsNumbersFromZeroToOneAnewForEachHost) {
  for (int i = 0; i < 1000; ++i) {
    const double draw = host().random_uniform();
    ASSERT_GE(draw, 0);
    ASSERT_LT(draw, 1);
  }
  EXPECT_NE(host().random_uniform(), pair.host(0).random_uniform());
}

TEST_F(RealHostTest, PutsOnRecordWhatHappens) {
  await(context(), host().clock().adjust_frequency(5000));
  host().report_exchange({.peer = 0, .t1 = HostTime(from_ms(1)), .t2 = {}, .t3 = {}, .t4 = {}});
  host().report_outcome({.slave = 1, .synchronised = true, .passes = 2, .message = ""});
  host().report_delays({.slave = 1, .pass = 2, .t_l = from_ms(3)});
  const auto& events = pair.events(1);
  ASSERT_EQ(events.size(), 4u);
  EXPECT_DOUBLE_EQ(std::get<ClockAdjustment>(events[0]).rate_ppb, 5000);
  EXPECT_EQ(std::get<ClockAdjustment>(events[0]).host, 1u);
  EXPECT_EQ(std::get<ExchangeEvent>(events[1]).host, 1u);
  EXPECT_EQ(std::get<ExchangeEvent>(events[1]).exchange.t1, HostTime(from_ms(1)));
  EXPECT_EQ(std::get<SyncOutcome>(events[2]).passes, 2u);
  EXPECT_EQ(std::get<SessionDelays>(events[3]).t_l, from_ms(3));
  EXPECT_TRUE(pair.events(0).empty());
}

TEST_F(RealHostTest, TheFeedKeepsTheLast1024Frames) {
  for (std::uint32_t i = 0; i < 1030; ++i) host().deliver(frame_of(i));
  for (std::uint32_t i = 6; i < 1030; ++i) {
    const auto frame = await(context(), host().frame_feed()->next(SteadyTime{}));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->counter, i);
  }
  EXPECT_FALSE(await(context(), host().frame_feed()->next(SteadyTime{})));
}

Task<void> take_frame(FrameFeed& feed, SteadyTime deadline, std::optional<FrameArrival>& frame,
                      bool& returned) {
  frame = co_await feed.next(deadline);
  returned = true;
}

TEST_F(RealHostTest, TheFeedWaitsForAFrameAndNoLongerThanTheDeadline) {
  bool returned = false;
  std::optional<FrameArrival> frame;
  const SteadyTime far = host().steady_clock().now() + std::chrono::hours(1);
  boost::asio::co_spawn(context(), take_frame(*host().frame_feed(), far, frame, returned),
                        boost::asio::detached);
  await(context(), host().sleep_for(from_ms(5)));
  EXPECT_FALSE(returned);
  host().deliver(frame_of(77));
  run_until(context(), [&] { return returned; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->counter, 77u);

  const SteadyTime near = host().steady_clock().now() + from_ms(10);
  EXPECT_FALSE(await(context(), host().frame_feed()->next(near)));
  EXPECT_GE(host().steady_clock().now(), near);
}

TEST_F(RealHostTest, LeavesTheClockWhenItGoes) {
  boost::asio::io_context other(1);
  SoftwareClock clock(other, {});
  PeerNetwork network(other, {.me = 0, .listen = {"127.0.0.1", 0}, .peers = {{}}, .key = {}},
                      clock);
  int events = 0;
  {
    const RealHost brief(other, 0, clock, network, [&](const RecordingEvent&) { ++events; });
    await(other, clock.adjust_frequency(1));
  }
  await(other, clock.adjust_frequency(2));
  EXPECT_EQ(events, 1);
}

Task<std::optional<ReceivedMessage>> exchange(RealHost& from, RealHost& to, Transport transport,
                                              Bytes bytes) {
  co_await from.open_channel(to.id(), transport).send(std::move(bytes));
  const SteadyTime deadline = to.steady_clock().now() + std::chrono::seconds(10);
  co_return co_await to.open_channel(from.id(), transport).receive(deadline);
}

TEST_F(RealHostTest, ReceiveStampsAreOnItsOwnClocks) {
  pair.connect();
  for (const Transport transport : {Transport::kStream, Transport::kDatagram}) {
    for (const PeerId to : {0u, 1u}) {
      const MonotonicTime before = monotonic_now();
      const auto message = await(
          context(), exchange(pair.host(1 - to), pair.host(to), transport, Bytes{std::byte{42}}));
      const MonotonicTime after = monotonic_now();
      ASSERT_TRUE(message);
      EXPECT_EQ(message->bytes, Bytes{std::byte{42}});
      const SoftwareClock& clock = pair.clock(to);
      // The kernel stamps on its other clock: a few microseconds between the two are its own.
      EXPECT_GE(message->received, clock.system_at(before) - from_ms(1));
      EXPECT_LE(message->received, clock.system_at(after) + from_ms(1));
      EXPECT_GE(message->received_steady, clock.steady_at(before) - from_ms(1));
      EXPECT_LE(message->received_steady, clock.steady_at(after) + from_ms(1));
    }
  }
}

}  // namespace
}  // namespace simbench::hardware
