#include "evaluation/scoring/session_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/evaluation/test_capture.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

SessionDelays delays_of(PeerId slave, std::uint32_t pass, double t_l_ms) {
  return {.slave = slave,
          .pass = pass,
          .t_l = from_ms(t_l_ms),
          .t_t = from_ms(2),
          .t_d = from_ms(t_l_ms + 2),
          .get = from_ms(0.5),
          .set = from_ms(3.5)};
}

ExchangeEvent exchange_of(PeerId slave, std::int64_t begin_ns, std::int64_t end_ns) {
  return {.host = 0,
          .exchange = {.peer = slave,
                       .t1 = HostTime(Nanoseconds(begin_ns)),
                       .t2 = {},
                       .t3 = HostTime{},
                       .t4 = HostTime(Nanoseconds(end_ns))}};
}

SeedScore score_of(const SessionScores& sessions) {
  SeedScore score;
  sessions.add_to(score);
  return score;
}

TEST(SessionScores, AreMeansOverTheSlavesOfTheirLastPass) {
  SessionScores sessions(4);
  sessions.add(delays_of(1, 1, 100));
  sessions.add(delays_of(3, 1, 5));
  sessions.add(delays_of(1, 2, 3));
  const SeedScore score = score_of(sessions);
  EXPECT_DOUBLE_EQ(score.t_l_ms, 4);
  EXPECT_DOUBLE_EQ(score.t_t_ms, 2);
  EXPECT_DOUBLE_EQ(score.t_d_ms, 6);
  EXPECT_DOUBLE_EQ(score.session_passes, 1.5);
  EXPECT_DOUBLE_EQ(score.get_time_ms, 0.5);
  EXPECT_DOUBLE_EQ(score.set_time_ms, 3.5);
  EXPECT_THAT(score.message_time_ms, IsNan()) << "no exchange was recorded";
  ASSERT_EQ(score.sessions.size(), 2U);
  EXPECT_EQ(score.sessions[0].pass, 2U);
  EXPECT_EQ(score.sessions[1].slave, 3U);
}

// T_r - T_m is 14 ms: two messages of 5 ms, a set of 3.5 and a get of 0.5.
TEST(SessionScores, AMessageIsHalfOfWhatTheExchangeTookBesideTheCalls) {
  SessionScores sessions(2);
  sessions.add(exchange_of(1, 0, 90'000'000));
  sessions.add(delays_of(1, 1, 3));
  sessions.add(exchange_of(1, 1'000'000'000, 1'014'000'000));
  EXPECT_DOUBLE_EQ(score_of(sessions).message_time_ms, 5);
}

TEST(SessionScores, OtherExchangesChangeNothing) {
  SessionScores sessions(2);
  sessions.add(delays_of(1, 1, 3));
  sessions.add(exchange_of(1, 0, 14'000'000));
  ExchangeEvent asked = exchange_of(1, 0, 99'000'000);
  asked.host = 1;  // a slave's
  sessions.add(asked);
  ExchangeEvent lost = exchange_of(1, 0, 99'000'000);
  lost.exchange.t4.reset();
  sessions.add(lost);
  sessions.add(exchange_of(7, 0, 99'000'000));
  sessions.add(delays_of(7, 1, 99));
  EXPECT_DOUBLE_EQ(score_of(sessions).message_time_ms, 5);
  EXPECT_DOUBLE_EQ(score_of(sessions).t_l_ms, 3);
}

TEST(SessionScores, WithoutSessionsNothingExists) {
  SessionScores sessions(2);
  sessions.add(exchange_of(1, 0, 14'000'000));
  const SeedScore score = score_of(sessions);
  EXPECT_THAT(score.t_l_ms, IsNan());
  EXPECT_THAT(score.session_passes, IsNan());
  EXPECT_THAT(score.message_time_ms, IsNan());
  EXPECT_TRUE(score.sessions.empty());
}

TEST(SessionScores, StampsOfARecordingMayBeAnything) {
  using Limits = std::numeric_limits<std::int64_t>;
  SessionScores sessions(2);
  SessionDelays extreme = delays_of(1, 1, 0);
  extreme.get = extreme.set = Nanoseconds(Limits::max());
  sessions.add(extreme);
  sessions.add(exchange_of(1, Limits::max(), Limits::min()));
  EXPECT_LT(score_of(sessions).message_time_ms, -1e13);
}

TEST(SessionScores, AreInTheScoreOfACapture) {
  PipelineScorer scorer(arrival_setup());
  const TestCapture capture(2, 1);
  capture.record(scorer);
  scorer.on_event(delays_of(1, 1, 3));
  scorer.on_event(exchange_of(1, 0, 14'000'000));
  const SeedScore score = scorer.finish();
  EXPECT_DOUBLE_EQ(score.t_l_ms, 3);
  EXPECT_DOUBLE_EQ(score.message_time_ms, 5);
}

}  // namespace
}  // namespace simbench::evaluation
