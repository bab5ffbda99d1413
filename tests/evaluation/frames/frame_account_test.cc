#include "evaluation/frames/frame_account.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include "tests/evaluation/frames/steady_stream.h"

namespace simbench::evaluation {
namespace {

// The frames at [from, from + count) never arrived.
RecordedStream without(RecordedStream stream, std::ptrdiff_t from, std::ptrdiff_t count) {
  stream.frames.erase(stream.frames.begin() + from, stream.frames.begin() + from + count);
  return stream;
}

// From this frame on the counter lacks `count` periods.
RecordedStream unexposed(RecordedStream stream, std::size_t from, std::uint64_t count) {
  for (std::size_t i = from; i < stream.frames.size(); ++i) stream.frames[i].counter -= count;
  return stream;
}

void expect_account(const RecordedStream& stream, std::int64_t lost, std::int64_t never_exposed,
                    std::int64_t unknown) {
  const FrameAccount account = frame_account(stream);
  EXPECT_EQ(account.delivered, static_cast<std::int64_t>(stream.frames.size()));
  EXPECT_EQ(account.lost, lost);
  EXPECT_EQ(account.never_exposed, never_exposed);
  EXPECT_EQ(account.unknown, unknown);
}

TEST(FrameAccount, ACleanStreamLacksNothing) {
  expect_account(steady_stream("a", 1000, 40, no_latency), 0, 0, 0);
  expect_account(steady_stream("a", 1, 0, no_latency), 0, 0, 0);
  expect_account({}, 0, 0, 0);
}

TEST(FrameAccount, LossesCountFromTheFirstSecondOn) {
  // 3 of them within the first five seconds of 33.
  const RecordedStream all = steady_stream("a", 1000, 0, no_latency);
  expect_account(without(without(all, 700, 4), 60, 3), 7, 0, 0);
}

TEST(FrameAccount, PeriodsThatTheCounterSkipsWereNeverExposed) {
  const RecordedStream all = steady_stream("a", 1000, 0, no_latency);
  expect_account(unexposed(without(all, 500, 5), 500, 5), 0, 5, 0);
  // The camera counted two of five missing frames.
  expect_account(unexposed(without(all, 500, 5), 500, 3), 2, 3, 0);
}

TEST(FrameAccount, WithoutACounterMissingPeriodsAreUnknown) {
  RecordedStream stream = without(steady_stream("a", 1000, 0, no_latency), 500, 5);
  stream.counted = false;
  for (std::size_t i = 0; i < stream.frames.size(); ++i) stream.frames[i].counter = i;
  expect_account(stream, 0, 0, 5);
}

TEST(FrameAccount, WhereTheCounterStartsAgainMissingPeriodsAreUnknown) {
  RecordedStream stream = without(steady_stream("a", 1000, 0, no_latency), 500, 5);
  for (std::size_t i = 500; i < stream.frames.size(); ++i) stream.frames[i].counter -= 400;
  expect_account(stream, 0, 0, 5);
  EXPECT_EQ(frame_account(stream).counter_restarts, 1);
}

TEST(FrameAccount, AJumpOfTheCounterIsNoLoss) {
  for (const std::uint64_t jump :
       {std::uint64_t{1000}, std::uint64_t{1} << 32, (std::uint64_t{1} << 32) - 1}) {
    RecordedStream stream = steady_stream("a", 100, 0, no_latency);
    for (std::size_t i = 50; i < 100; ++i) stream.frames[i].counter += jump;
    expect_account(stream, 0, 0, 0);
    EXPECT_EQ(frame_account(stream).counter_jumps, 1);
    EXPECT_EQ(frame_account(stream).largest_jump, jump + 1);
  }
  // A pause in which the camera went on counting is a loss.
  expect_account(without(steady_stream("a", 3000, 0, no_latency), 500, 2000), 2000, 0, 0);
}

TEST(FrameAccount, AnyCountersGiveCountsFromZero) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    RecordedStream stream = steady_stream("a", 60, 0, no_latency);
    for (StampedFrame& frame : stream.frames) {
      if (random() % 4 == 0) frame.counter = random();
      if (random() % 4 == 0) frame.sensor = Nanoseconds(static_cast<std::int64_t>(random() >> 2));
    }
    const FrameAccount account = frame_account(stream);
    EXPECT_GE(account.lost, 0);
    EXPECT_GE(account.never_exposed, 0);
    EXPECT_GE(account.unknown, 0);
  }
}

}  // namespace
}  // namespace simbench::evaluation
