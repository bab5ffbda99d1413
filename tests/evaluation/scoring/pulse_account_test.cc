#include "evaluation/scoring/pulse_account.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kFirst = 10;
constexpr std::int64_t kPulses = 20;

SetCounts counts_of(const PulseAccount& account) {
  SetCounts counts;
  account.add_to(counts);
  return counts;
}

// A camera that exposes each pulse from `from` on with the counters from 100, but these.
void add_camera(PulseAccount& account, std::uint32_t camera, std::int64_t from, std::int64_t end,
                const std::vector<std::int64_t>& lost,
                const std::vector<std::int64_t>& not_exposed = {}) {
  std::uint32_t counter = 100;
  for (std::int64_t pulse = from; pulse < end; ++pulse) {
    if (std::ranges::count(not_exposed, pulse) > 0) continue;
    if (std::ranges::count(lost, pulse) == 0) account.add(camera, pulse, counter);
    ++counter;
  }
}

TEST(PulseAccount, CountsWhatIsDueAndExposed) {
  PulseAccount account(kFirst, kPulses, 2);
  for (const std::uint32_t camera : {0U, 1U}) add_camera(account, camera, 5, 35, {});
  EXPECT_EQ(counts_of(account).due_pulses, kPulses);
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses);
}

// Pulses 10 to 29, of which the second camera exposes the even ones: 10 are due, and a lost frame
// of it was exposed.
TEST(PulseAccount, WhereACameraExposesEverySecondPulseTheseAreDue) {
  PulseAccount account(kFirst, kPulses, 2, /*due_every=*/2);
  add_camera(account, 0, 5, 35, {13, 14}, {20});
  std::vector<std::int64_t> odd;
  for (std::int64_t pulse = 5; pulse < 35; pulse += 2) odd.push_back(pulse);
  add_camera(account, 1, 5, 35, {16}, odd);
  EXPECT_EQ(counts_of(account).due_pulses, 10);
  EXPECT_EQ(counts_of(account).exposed_pulses, 9);
}

TEST(PulseAccount, ALostFrameWasExposedAMissingPulseWasNot) {
  PulseAccount account(kFirst, kPulses, 2);
  add_camera(account, 0, 5, 35, {12, 13, 20});
  add_camera(account, 1, 5, 35, {12}, {17, 18, 25});
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses - 3);
}

// Exposures of 1.3 periods: each second pulse is ignored.
TEST(PulseAccount, ASlowCameraExposesEachSecondPulse) {
  PulseAccount account(kFirst, kPulses, 1);
  for (std::uint32_t frame = 0; frame < 20; ++frame) account.add(0, 2 * frame, frame);
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses / 2);
}

TEST(PulseAccount, CamerasThatMissDifferentPulsesExposeNoneTogether) {
  PulseAccount account(kFirst, kPulses, 2);
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    account.add(0, 2 * frame, frame);
    account.add(1, 2 * frame + 1, frame);
  }
  EXPECT_EQ(counts_of(account).exposed_pulses, 0);
}

TEST(PulseAccount, InAGapOfBothTheExposuresLieEvenly) {
  PulseAccount account(kFirst, kPulses, 1);
  add_camera(account, 0, 5, 12, {});
  // Pulses 12 to 16 are missing, two of them were exposed.
  for (std::int64_t pulse = 17; pulse < 35; ++pulse) {
    account.add(0, pulse, static_cast<std::uint32_t>(107 + 2 + pulse - 17));
  }
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses - 3);
}

TEST(PulseAccount, ACameraThatStopsExposesNothingMore) {
  PulseAccount account(kFirst, kPulses, 1);
  add_camera(account, 0, 5, 20, {});
  EXPECT_EQ(counts_of(account).exposed_pulses, 10);
}

TEST(PulseAccount, TheLastFramesOfACaptureMayBeLost) {
  PulseAccount account(kFirst, kPulses, 1);
  add_camera(account, 0, 5, 28, {});
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses);
}

TEST(PulseAccount, ACameraThatBeginsLateExposedNothingBefore) {
  PulseAccount account(kFirst, kPulses, 1);
  add_camera(account, 0, 14, 35, {});
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses - 4);
}

TEST(PulseAccount, ACounterThatStartsAnewMakesNoExposures) {
  PulseAccount account(kFirst, kPulses, 1);
  add_camera(account, 0, 5, 15, {});
  for (std::int64_t pulse = 18; pulse < 35; ++pulse) {
    account.add(0, pulse, static_cast<std::uint32_t>(pulse - 18));
  }
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses - 3);
}

TEST(PulseAccount, TheCounterMayWrap) {
  PulseAccount account(kFirst, kPulses, 1);
  std::uint32_t counter = UINT32_MAX - 10;
  for (std::int64_t pulse = 5; pulse < 35; ++pulse, ++counter) {
    if (pulse != 15 && pulse != 22) account.add(0, pulse, counter);
  }
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses);
}

// A gap is the same seen from any window: what two neighbouring windows count, both together do.
TEST(PulseAccount, AGapIsDividedAlikeInEveryWindow) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    PulseAccount left(0, kFirst, 1), right(kFirst, kPulses, 1), both(0, kFirst + kPulses, 1);
    std::uint32_t counter = 7;
    for (std::int64_t pulse = 0; pulse < 40; ++pulse) {
      const bool is_last = pulse == 39;
      if (random() % 3 == 0) ++counter;
      if (random() % 5 != 0 && pulse != 0 && !is_last) continue;
      for (PulseAccount* account : {&left, &right, &both}) account->add(0, pulse, counter);
      ++counter;
    }
    EXPECT_EQ(counts_of(left).exposed_pulses + counts_of(right).exposed_pulses,
              counts_of(both).exposed_pulses);
  }
}

// As of a recording that is damaged: the work grows with the window alone.
TEST(PulseAccount, AFrameMayBeOfAnyPulse) {
  PulseAccount account(kFirst, kPulses, 1);
  account.add(0, 0, 0);
  account.add(0, std::numeric_limits<std::int64_t>::max(), 3'000'000'000);
  EXPECT_EQ(counts_of(account).exposed_pulses, 0);
  PulseAccount from_zero(0, kPulses, 1);
  from_zero.add(0, std::numeric_limits<std::int64_t>::max(), 5);
  EXPECT_EQ(counts_of(from_zero).exposed_pulses, 0);
}

TEST(PulseAccount, WithoutFramesNothingWasExposed) {
  EXPECT_EQ(counts_of(PulseAccount(kFirst, kPulses, 3)).exposed_pulses, 0);
  EXPECT_EQ(counts_of(PulseAccount(kFirst, kPulses, 3)).due_pulses, kPulses);
}

TEST(PulseAccount, TheOrderOfDeliveryDoesNotMatter) {
  PulseAccount account(kFirst, kPulses, 1);
  for (std::int64_t pulse = 34; pulse >= 5; --pulse) {
    if (pulse != 16) account.add(0, pulse, static_cast<std::uint32_t>(pulse));
  }
  EXPECT_EQ(counts_of(account).exposed_pulses, kPulses);
}

}  // namespace
}  // namespace simbench::evaluation
