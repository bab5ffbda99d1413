#include "hardware/relay/delay_queue.h"

#include <gtest/gtest.h>

#include <vector>

namespace simbench::hardware {
namespace {

TEST(DelayQueue, DoesThingsInOrderAndNeverEarly) {
  boost::asio::io_context context;
  DelayQueue queue(context);
  const MonotonicTime begin = monotonic_now();
  std::vector<int> order;
  const auto add = [&](double after_ms, int name) {
    const MonotonicTime at = begin + from_ms(after_ms);
    Bytes one_byte(1);
    ASSERT_TRUE(queue.add(at, one_byte, [&order, at, name](const Bytes& message) {
      EXPECT_GE(monotonic_now(), at);
      EXPECT_EQ(message.size(), 1u);
      order.push_back(name);
    }));
  };
  add(9, 4);
  add(3, 1);
  add(6, 2);
  add(6, 3);
  add(-1, 0);
  context.run();
  EXPECT_EQ(order, (std::vector{0, 1, 2, 3, 4}));
  EXPECT_EQ(queue.waiting(), 0u);
  EXPECT_GE(queue.lateness(0).value(), Nanoseconds(0));
  EXPECT_GE(queue.lateness(1).value(), from_ms(1)) << "the one that was due before it was added";
}

TEST(DelayQueue, WhatIsAddedMeanwhileHasItsTurn) {
  boost::asio::io_context context;
  DelayQueue queue(context);
  int done = 0;
  Bytes none;
  queue.add(monotonic_now() + from_ms(1), none, [&](const Bytes&) {
    ++done;
    queue.add(monotonic_now() + from_ms(1), none, [&](const Bytes&) { ++done; });
  });
  context.run();
  EXPECT_EQ(done, 2);
}

TEST(DelayQueue, IsBounded) {
  boost::asio::io_context context;
  DelayQueue queue(context);
  Bytes none;
  const MonotonicTime far = monotonic_now() + std::chrono::hours(1);
  for (std::size_t i = 0; i < DelayQueue::kMaxWaiting; ++i) {
    ASSERT_TRUE(queue.add(far, none, [](const Bytes&) {}));
  }
  EXPECT_FALSE(queue.add(far, none, [](const Bytes&) {}));
  EXPECT_EQ(queue.waiting(), DelayQueue::kMaxWaiting);

  DelayQueue by_bytes(context);
  Bytes all(DelayQueue::kMaxBytes);
  EXPECT_TRUE(by_bytes.add(far, all, [](const Bytes&) {}));
  Bytes one_byte(1);
  EXPECT_FALSE(by_bytes.add(far, one_byte, [](const Bytes&) {}));
  EXPECT_EQ(one_byte.size(), 1U) << "what is refused is not taken";
  queue.stop();
  by_bytes.stop();
  context.run();  // ends at once
  EXPECT_EQ(queue.waiting(), 0u);
  EXPECT_FALSE(queue.lateness(0.5).has_value());
}

}  // namespace
}  // namespace simbench::hardware
