#include "algorithms/host_sync/ntp/w32time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "algorithms/host_sync/ntp/ntp_association.h"
#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {
namespace {

constexpr Nanoseconds kOneWay{2'000'000};

W32TimeSettings settings_with_poll(double poll_s) {
  W32TimeSettings settings;
  settings.poll_interval = from_ms(poll_s * 1e3);
  settings.start_spread = Nanoseconds{0};
  return settings;
}

TEST(W32TimeRule, TheDocumentedExampleIsSlewedAt47UnitsATick) {
  const auto correction = w32time_correction(from_ms(540), settings_with_poll(1024));
  EXPECT_FALSE(correction.set);
  EXPECT_NEAR(correction.units_per_tick, 47.08, 0.01);
  EXPECT_NEAR(correction.rate_ppb, 301e3, 1e3);
}

TEST(W32TimeRule, ASlewTakesTheSameTimeForEveryOffset) {
  const double ticks = 16 * 7 * 1024;
  for (const double offset_ms : {0.01, 1.0, 540.0, -540.0, 999.0}) {
    const auto correction = w32time_correction(from_ms(offset_ms), settings_with_poll(1024));
    EXPECT_NEAR(std::abs(offset_ms) * 1e6 / (correction.rate_ppb * 1e-9), ticks * 15.625e6, 1.0)
        << offset_ms;
  }
}

TEST(W32TimeRule, FromTheLargestPhaseOffsetOnTheClockIsSet) {
  const W32TimeSettings settings = settings_with_poll(1024);
  EXPECT_FALSE(w32time_correction(from_ms(1000) - Nanoseconds{1}, settings).set);
  EXPECT_TRUE(w32time_correction(from_ms(1000), settings).set);
  EXPECT_FALSE(w32time_correction(from_ms(-1000) + Nanoseconds{1}, settings).set);
  EXPECT_TRUE(w32time_correction(from_ms(-1000), settings).set);
}

TEST(W32TimeRule, BeyondHalfTheClockRateTheClockIsSet) {
  // 78125 units a tick at a poll of 16 s and PhaseCorrectRate 1: 2.0 s.
  W32TimeSettings settings = settings_with_poll(16);
  settings.phase_correct_rate = 1;
  settings.max_allowed_phase_offset = from_ms(300e3);
  EXPECT_FALSE(w32time_correction(from_ms(2000), settings).set);
  EXPECT_TRUE(w32time_correction(from_ms(2000) + Nanoseconds{100}, settings).set);
}

TEST(W32TimeRateChange, ThePllHasTheDocumentedGain) {
  W32TimeSettings settings = settings_with_poll(64);
  settings.rate = W32TimeRate::kPll;
  // 4 * 4096 ticks of 15.625 ms: 256 s.
  EXPECT_NEAR(w32time_rate_change(from_ms(10), from_ms(64e3), settings),
              10e-3 * 64 / (1024.0 * 1024), 1e-18);
  settings.poll_interval = from_ms(1024e3);
  EXPECT_NEAR(w32time_rate_change(from_ms(-10), from_ms(1024e3), settings), -10e-3 / (256 * 1024.0),
              1e-18);
  settings.frequency_correct_rate = 2;
  EXPECT_NEAR(w32time_rate_change(from_ms(-10), from_ms(1024e3), settings), -10e-3 / (64 * 1024.0),
              1e-18);
}

TEST(W32TimeRateChange, TheFllFadesInAboveFourMinutes) {
  W32TimeSettings pll = settings_with_poll(1024);
  pll.rate = W32TimeRate::kPll;
  const auto fll = [&pll](double interval_s) {
    W32TimeSettings hybrid = pll;
    hybrid.rate = W32TimeRate::kHybrid;
    const Nanoseconds interval = from_ms(interval_s * 1e3);
    return w32time_rate_change(from_ms(100), interval, hybrid) -
           w32time_rate_change(from_ms(100), interval, pll);
  };
  EXPECT_NEAR(fll(256), 0, 1e-15);
  EXPECT_NEAR(fll(1024), 0.1 * 0.75 / (4 * 1024), 1e-12);
  EXPECT_NEAR(fll(32768), 0.1 / (4 * 32768.0), 1e-12);
}

TEST(W32TimeRateChange, HeldOrWithoutAnIntervalThereIsNone) {
  W32TimeSettings settings = settings_with_poll(1024);
  EXPECT_EQ(w32time_rate_change(from_ms(100), Nanoseconds{0}, settings), 0);
  settings.rate = W32TimeRate::kHeld;
  EXPECT_EQ(w32time_rate_change(from_ms(100), from_ms(1024e3), settings), 0);
}

// A clock that lacks 10 ppm, on paper: each poll the phase rule takes its part of the offset, and
// after the hold the rate changes.
TEST(W32TimeRateChange, AtTheDocumentedPollsTheLoopSettles) {
  for (const double poll_s : {64.0, 1024.0, 32768.0}) {
    for (const W32TimeRate rate : {W32TimeRate::kHybrid, W32TimeRate::kPll}) {
      W32TimeSettings settings = settings_with_poll(poll_s);
      settings.rate = rate;
      const double corrected = std::min(1 / (16 * 7 * 15.625e-3), 1.0);
      double lacking = 10e-6;
      double offset_s = 0;
      for (int poll = 0; poll < 5000; ++poll) {
        lacking -= w32time_rate_change(from_seconds(offset_s), settings.poll_interval, settings);
        offset_s += lacking * poll_s - corrected * offset_s;
      }
      EXPECT_LT(std::abs(lacking), 0.1e-6) << poll_s;
      EXPECT_LT(std::abs(offset_s), 0.01 * 10e-6 * poll_s) << poll_s;
    }
  }
}

TEST(W32Time, TheRateIsCorrectedOnceTheHoldIsOver) {
  ScriptWorld world(2);
  world.connect(kOneWay);
  for (int poll = 0; poll < 6; ++poll) {
    world.call_at(from_ms(1024e3 * poll - (poll > 0 ? 500e3 : 0)),
                  [&world] { world.host(0).offset += from_ms(10); });
  }
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(4.5 * 1024e3));
  EXPECT_EQ(world.host(1).slews.size(), 5U);
  EXPECT_TRUE(world.host(1).frequencies_ppb.empty());
  world.run(from_ms(5.5 * 1024e3));
  ASSERT_EQ(world.host(1).frequencies_ppb.size(), 1U);
  EXPECT_NEAR(world.host(1).frequencies_ppb[0], 10e6 * (0.75 / 4 + 1.0 / 256) / 1024, 1);
}

TEST(W32Time, SetsALargeOffsetAndSlewsASmallOne) {
  ScriptWorld world(3);
  world.connect(kOneWay);
  world.host(0).offset = from_ms(10e3);
  world.host(1).offset = from_ms(-5e3);
  world.host(2).offset = from_ms(10.3e3);
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(100));
  EXPECT_EQ(world.host(1).steps, std::vector{from_ms(15e3)});
  EXPECT_TRUE(world.host(1).slews.empty());
  EXPECT_TRUE(world.host(2).steps.empty());
  ASSERT_EQ(world.host(2).slews.size(), 1U);
  EXPECT_EQ(world.host(2).slews.front().offset, from_ms(-300));
  EXPECT_NEAR(world.host(2).slews.front().rate_ppb, 300e6 / (16 * 7 * 1024 * 15.625e6) * 1e9, 1);
  for (const PeerId slave : {1U, 2U}) {
    EXPECT_EQ(world.host(slave).lead_over(world.host(0)), Nanoseconds{0});
    ASSERT_EQ(world.host(slave).outcomes.size(), 1U);
    EXPECT_TRUE(world.host(slave).outcomes.front().synchronised);
    EXPECT_EQ(world.host(slave).outcomes.front().slave, slave);
  }
}

TEST(W32Time, ReportsTheFourStamps) {
  ScriptWorld world(2);
  world.connect(kOneWay);
  world.host(0).offset = from_ms(400);
  world.host(0).costs.send = from_ms(0.1);
  world.host(1).costs.send = from_ms(0.1);
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(100));
  ASSERT_EQ(world.host(1).exchanges.size(), 1U);
  const Exchange& exchange = world.host(1).exchanges.front();
  EXPECT_EQ(exchange.peer, 0U);
  EXPECT_EQ(*exchange.t1, HostTime{});
  EXPECT_EQ(*exchange.t2, HostTime{from_ms(400 + 0.1 + 2)});
  EXPECT_EQ(*exchange.t3, HostTime{from_ms(400 + 0.1 + 2)});
  EXPECT_EQ(*exchange.t4, HostTime{from_ms(0.2 + 4)});
}

TEST(W32Time, PollsAtItsIntervalAfterARandomStart) {
  ScriptWorld world(3);
  world.connect(kOneWay);
  world.host(1).uniform = 0.25;
  world.host(2).uniform = 0.5;
  W32TimeSettings settings = settings_with_poll(1000);
  settings.start_spread = from_ms(100e3);
  W32Time algorithm(settings);
  world.run(algorithm, from_ms(3100e3));
  ASSERT_EQ(world.host(1).exchanges.size(), 4U);
  ASSERT_EQ(world.host(2).exchanges.size(), 4U);
  EXPECT_EQ(*world.host(1).exchanges[0].t1, HostTime{from_ms(25e3)});
  EXPECT_EQ(*world.host(2).exchanges[0].t1, HostTime{from_ms(50e3)});
  EXPECT_EQ(*world.host(1).exchanges[3].t1, HostTime{from_ms(3025e3) + 3 * 2 * kOneWay});
  EXPECT_EQ(world.host(1).outcomes.size(), 1U);
}

TEST(W32Time, ALostReplyIsAskedForAgain) {
  ScriptWorld world(2);
  world.connect(kOneWay);
  world.script_link(0, 1, [](std::size_t index, const Bytes&) {
    return index == 0 ? std::vector<Nanoseconds>{} : std::vector{kOneWay};
  });
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(10e3));
  ASSERT_EQ(world.host(1).exchanges.size(), 1U);
  EXPECT_EQ(world.host(1).outcomes.at(0).passes, 2U);
}

TEST(W32Time, ASilentServerIsAnOutcomeAndAskedAtTheNextPoll) {
  ScriptWorld world(2);
  world.connect(kOneWay);
  std::size_t requests = 0;
  world.script_link(1, 0, [&requests](std::size_t, const Bytes&) {
    ++requests;
    return std::vector<Nanoseconds>{};
  });
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(1000e3));
  EXPECT_EQ(requests, 4U);
  ASSERT_EQ(world.host(1).outcomes.size(), 1U);
  EXPECT_FALSE(world.host(1).outcomes.front().synchronised);
  EXPECT_EQ(world.host(1).outcomes.front().message,
            "slave 1: no valid reply from time server 0 to 4 requests; is it running and "
            "reachable?");
  world.run(from_ms(2000e3));
  EXPECT_EQ(requests, 8U);
  EXPECT_EQ(world.host(1).outcomes.size(), 1U);
}

using Spoil = void (*)(NtpPacket&);

// Whether the client takes a reply that would be right but for what `spoil` does to it.
bool takes_reply(Spoil spoil) {
  ScriptWorld world(2);
  world.script_link(1, 0, [&world, spoil](std::size_t, const Bytes& bytes) {
    const NtpPacket request = *decode_ntp_packet(bytes);
    NtpPacket reply = request;
    reply.mode = kNtpModeServer;
    reply.stratum = 1;
    reply.origin = request.transmit;
    reply.receive = to_ntp(HostTime{from_ms(5000)});
    reply.transmit = reply.receive;
    spoil(reply);
    world.call_at(world.now() + kOneWay,
                  [&world, reply] { world.host(1).deliver(0, encode(reply)); });
    return std::vector<Nanoseconds>{};
  });
  W32Time algorithm(settings_with_poll(1024));
  world.host(1).offset = from_ms(77);
  world.run(algorithm, from_ms(100e3));
  const bool taken = !world.host(1).exchanges.empty();
  EXPECT_EQ(world.host(1).offset != from_ms(77), taken);
  return taken;
}

TEST(W32Time, BogusRepliesAreIgnored) {
  EXPECT_TRUE(takes_reply([](NtpPacket&) {}));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { ++reply.origin.fraction; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.origin = {}; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.mode = kNtpModeClient; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.mode = 5; }));  // a broadcast
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.leap = kNtpLeapAlarm; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.stratum = 0; }));  // kiss of death
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.stratum = 16; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.transmit = {}; }));
  EXPECT_FALSE(takes_reply([](NtpPacket& reply) { reply.version = 7; }));
}

TEST(W32Time, ALateReplyToAnEarlierRequestIsIgnored) {
  ScriptWorld world(2);
  world.connect(kOneWay);
  world.script_link(0, 1, [](std::size_t index, const Bytes&) {
    return std::vector{index == 0 ? from_ms(1001) : kOneWay};  // after the second request
  });
  world.host(0).offset = from_ms(400);
  W32Time algorithm(settings_with_poll(1024));
  world.run(algorithm, from_ms(10e3));
  ASSERT_EQ(world.host(1).exchanges.size(), 1U);
  EXPECT_EQ(world.host(1).lead_over(world.host(0)), Nanoseconds{0});
}

TEST(W32Time, TheServerEchoesTheRequestAndIgnoresTheRest) {
  ScriptWorld world(2);
  std::vector<NtpPacket> replies;
  world.script_link(0, 1, [&replies](std::size_t, const Bytes& bytes) {
    replies.push_back(*decode_ntp_packet(bytes));
    return std::vector<Nanoseconds>{};
  });
  world.host(0).offset = from_ms(123);
  NtpPacket request;
  request.version = 4;
  request.transmit = {0xDEADBEEF, 0x12345678};
  NtpPacket broadcast = request;
  broadcast.mode = 5;
  world.call_at(from_ms(1), [&] {
    world.host(0).deliver(1, Bytes(3));
    world.host(0).deliver(1, encode(broadcast));
    world.host(0).deliver(1, encode(request));
  });
  W32Time algorithm(settings_with_poll(1024));
  world.start(algorithm.run_master(world.host(0), {1}));
  world.run(from_ms(10));
  ASSERT_EQ(replies.size(), 1U);
  const NtpPacket& reply = replies.front();
  EXPECT_EQ(reply.origin, request.transmit);
  EXPECT_EQ(reply.mode, kNtpModeServer);
  EXPECT_EQ(reply.version, 4);
  EXPECT_EQ(reply.stratum, 1);
  EXPECT_EQ(reply.receive, to_ntp(HostTime{from_ms(124)}));
  EXPECT_EQ(reply.transmit, to_ntp(HostTime{from_ms(124)}));
}

TEST(W32Time, RunsBeforeTheCapture) {
  W32Time algorithm((W32TimeSettings()));
  EXPECT_EQ(algorithm.warm_up(), from_ms(20 * 3600e3));
  EXPECT_EQ(algorithm.initial_clocks(), InitialClocks::kUnsynchronised);
}

}  // namespace
}  // namespace simbench
