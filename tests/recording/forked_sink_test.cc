#include "recording/forked_sink.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "recording/event.h"
#include "tests/recording/random_events.h"
#include "tests/recording/test_sink.h"

namespace simbench {
namespace {

KeptRecording random_recording(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  KeptRecording kept;
  kept.on_start({.hosts = 3, .cameras = {{0}, {2}}, .frame_rate_hz = 50});
  for (int i = 0; i < 200; ++i) notify(random_event(random, {.hosts = 3, .cameras = 2}), kept);
  return kept;
}

void expect_all_of(const KeptRecording& a, const KeptRecording& b) {
  EXPECT_TRUE(same(a.layout(), b.layout()));
  ASSERT_EQ(a.events().size(), b.events().size());
  for (std::size_t i = 0; i < a.events().size(); ++i) {
    EXPECT_TRUE(same(a.events()[i], b.events()[i])) << i;
  }
}

// Fails at a given frame.
class Failing final : public TestSink {
 public:
  explicit Failing(int frame) : left_(frame) {}
  void on_event(const RecordingEvent&) override { EXPECT_FALSE(has_failed_); }

 private:
  void frame_came(const FrameRecord&, const FrameTruth*) override {
    EXPECT_FALSE(has_failed_);
    if (left_-- > 0) return;
    has_failed_ = true;
    throw std::runtime_error("no more frames");
  }

  int left_;
  bool has_failed_ = false;
};

TEST(ForkedSink, EverySinkGetsEverything) {
  constexpr std::uint64_t kSeed = 4;
  SCOPED_TRACE(kSeed);
  const KeptRecording recording = random_recording(kSeed);
  KeptRecording first;
  KeptRecording second;
  ForkedSink fork({&first, &second});
  recording.play(fork);
  expect_all_of(first, recording);
  expect_all_of(second, recording);
  EXPECT_EQ(fork.failure(0), nullptr);
}

TEST(ForkedSink, BlocksOfFramesToo) {
  const std::vector<FrameRecord> frames(3);
  const std::vector<FrameTruth> truths(3);
  KeptRecording first;
  KeptRecording second;
  ForkedSink fork({&first, &second});
  fork.on_frames(frames, truths);
  fork.on_frames(frames, {});
  EXPECT_EQ(first.events().size(), 6U);
  EXPECT_EQ(second.events().size(), 6U);
}

TEST(ForkedSink, OneThatFailsGetsNothingMoreAndTheOthersGoOn) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(kSeed);
  const KeptRecording recording = random_recording(kSeed);
  Failing failing(3);
  KeptRecording kept;
  ForkedSink fork({&failing, &kept});
  recording.play(fork);
  expect_all_of(kept, recording);
  EXPECT_EQ(fork.failure(1), nullptr);
  EXPECT_THROW(std::rethrow_exception(fork.failure(0)), std::runtime_error);
}

TEST(ForkedSink, ThrowsOnceAllHaveFailed) {
  const KeptRecording recording = random_recording(6);
  Failing first(1);
  Failing second(4);
  ForkedSink fork({&first, &second});
  EXPECT_THROW(recording.play(fork), std::runtime_error);
  EXPECT_NE(fork.failure(0), nullptr);
  EXPECT_NE(fork.failure(1), nullptr);
}

}  // namespace
}  // namespace simbench
