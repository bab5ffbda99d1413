#include "algorithms/certificates/stamped_facts.h"

#include <gtest/gtest.h>

#include <optional>

namespace simbench {
namespace {

HostTime reading_ms(double ms) { return HostTime(from_ms(ms)); }
double steady_ms(SteadyTime at) { return to_ms(at.time_since_epoch()); }

// Host 1's system clock is 500 ms ahead of its steady clock, host 0's shows it.
StampedFacts two_hosts(Nanoseconds stamp_error,
                       std::optional<Nanoseconds> estimate_error = std::nullopt) {
  StampedFacts facts(2, stamp_error, estimate_error);
  facts.add({.host = 0});
  facts.add({.host = 1, .before = reading_ms(500), .after = reading_ms(500)});
  return facts;
}

TEST(StampedFacts, AnExchangeIsAMessageEachWay) {
  const Exchange exchange{.peer = 0,
                          .t1 = reading_ms(600),
                          .t2 = reading_ms(101),
                          .t3 = reading_ms(102),
                          .t4 = reading_ms(603)};
  const ExchangeMessages found = two_hosts(from_ms(0.25)).messages_of(1, exchange);
  EXPECT_EQ(found.unusable, 0U);
  ASSERT_TRUE(found.usable[0] && found.usable[1]);
  EXPECT_EQ(found.usable[0]->from, 1U);
  EXPECT_EQ(found.usable[0]->to, 0U);
  // Outward by the error of the stamps.
  EXPECT_NEAR(steady_ms(found.usable[0]->sent), 99.75, 1e-5);
  EXPECT_NEAR(steady_ms(found.usable[0]->received), 101.25, 1e-5);
  EXPECT_EQ(found.usable[1]->from, 0U);
  EXPECT_NEAR(steady_ms(found.usable[1]->sent), 101.75, 1e-5);
  EXPECT_NEAR(steady_ms(found.usable[1]->received), 103.25, 1e-5);
}

TEST(StampedFacts, EstimatesCountOnlyWithinAnErrorThatIsStated) {
  const Exchange exchange{.peer = 0,
                          .t1 = reading_ms(600),
                          .t2 = reading_ms(101),
                          .t3 = reading_ms(102),
                          .t4 = reading_ms(603),
                          .is_estimated = true};
  const ExchangeMessages without = two_hosts(from_ms(0.25)).messages_of(1, exchange);
  EXPECT_TRUE(without.is_left_out);
  EXPECT_FALSE(without.usable[0] || without.usable[1]);
  const ExchangeMessages with = two_hosts(from_ms(0.25), from_ms(0.5)).messages_of(1, exchange);
  EXPECT_FALSE(with.is_left_out);
  ASSERT_TRUE(with.usable[0] && with.usable[1]);
  EXPECT_NEAR(steady_ms(with.usable[0]->sent), 99.25, 1e-5);
  EXPECT_NEAR(steady_ms(with.usable[1]->received), 103.75, 1e-5);
}

TEST(StampedFacts, OneStampOfThePeerStandsForBoth) {
  const Exchange exchange{
      .peer = 0, .t1 = reading_ms(600), .t2 = {}, .t3 = reading_ms(102), .t4 = reading_ms(603)};
  const ExchangeMessages found = two_hosts(Nanoseconds(0)).messages_of(1, exchange);
  ASSERT_TRUE(found.usable[0] && found.usable[1]);
  EXPECT_NEAR(steady_ms(found.usable[0]->received), 102, 1e-5);
  EXPECT_NEAR(steady_ms(found.usable[1]->sent), 102, 1e-5);
}

TEST(StampedFacts, ABroadcastIsOneMessage) {
  const Exchange exchange{
      .peer = 0, .t1 = {}, .t2 = {}, .t3 = reading_ms(102), .t4 = reading_ms(603)};
  const ExchangeMessages found = two_hosts(Nanoseconds(0)).messages_of(1, exchange);
  EXPECT_FALSE(found.usable[0]);
  EXPECT_TRUE(found.usable[1]);
  EXPECT_EQ(found.unusable, 0U);
}

// A step forward by 300 ms: what lies within it was never read.
TEST(StampedFacts, AStampThatNeverWasIsCounted) {
  StampedFacts facts = two_hosts(Nanoseconds(0));
  facts.add({.host = 1,
             .at = SteadyTime(from_ms(200)),
             .before = reading_ms(700),
             .after = reading_ms(1000)});
  const Exchange exchange{
      .peer = 0, .t1 = reading_ms(800), .t2 = reading_ms(301), .t3 = {}, .t4 = {}};
  const ExchangeMessages found = facts.messages_of(1, exchange);
  EXPECT_FALSE(found.usable[0]);
  EXPECT_EQ(found.unusable, 1U);
}

}  // namespace
}  // namespace simbench
