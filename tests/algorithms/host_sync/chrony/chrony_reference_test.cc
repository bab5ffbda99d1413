#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/host_sync/chrony/chrony.h"

namespace simbench {
namespace {

ChronyEstimate estimate(double offset_s, double frequency, double skew) {
  return {.at_s = 0,
          .offset_s = offset_s,
          .offset_sd_s = 10e-6,
          .frequency = frequency,
          .skew = skew,
          .sd_s = 20e-6};
}

TEST(ChronyReference, TheFirstGoodFrequencyIsTakenOver) {
  ChronyReference reference({});
  const ChronyCorrection correction = reference.update(estimate(0.1, 20e-6, 5e-6), 0, 0);
  EXPECT_NEAR(correction.frequency, 20e-6, 1e-15);
  EXPECT_NEAR(reference.skew(), 5e-6, 1e-8);
}

TEST(ChronyReference, AnUncertainFrequencyChangesNothing) {
  ChronyReference reference({});
  const ChronyCorrection correction = reference.update(estimate(0.1, 2e-3, 1.1e-3), 0, 0);
  EXPECT_EQ(correction.frequency, 0);
  EXPECT_EQ(correction.offset_s, 0.1);
}

TEST(ChronyReference, FrequenciesAreWeighedByTheirSkews) {
  ChronyReference reference({});
  reference.update(estimate(0, 20e-6, 2e-6), 0, 0);
  const double present = reference.skew();
  const double gain = 3 * present * present / (3 * present * present + 4e-6 * 4e-6);
  const ChronyCorrection correction = reference.update(estimate(0, 1e-6, 4e-6), 0, 0);
  EXPECT_NEAR(correction.frequency, gain * 1e-6, 1e-15);
  EXPECT_NEAR(reference.frequency(), 20e-6 + gain * 1e-6, 1e-12);
}

TEST(ChronyReference, TheOffsetIsThatOfNow) {
  ChronyReference reference({});
  EXPECT_NEAR(reference.update(estimate(1e-3, 10e-6, 1e-6), 50, 0).offset_s, 1.5e-3, 1e-15);
}

TEST(ChronyReference, AnOffsetOfOneDeviationTakesHalfOfThreeIntervals) {
  ChronyReference reference({});
  reference.update(estimate(0, 0, 1e-6), 0, 0);
  const ChronyCorrection one = reference.update(estimate(10e-6, 0, 1e-6), 64, 0);
  EXPECT_NEAR(10e-6 / one.slew_rate, 1.5 * 64, 1e-9);
  const ChronyCorrection ten = reference.update(estimate(50e-6, 0, 1e-6), 128, 50e-6);
  EXPECT_NEAR(100e-6 / ten.slew_rate, 1.5 * 64 / 10.0, 1e-9) << "what was left counts";
}

TEST(ChronyReference, ASlewIsNeitherTooShortNorTooFast) {
  ChronyReference reference({});
  EXPECT_NEAR(reference.update(estimate(1e-3, 0, 1e-6), 0, 0).slew_rate, 1e-3, 1e-15);
  EXPECT_NEAR(reference.update(estimate(-10, 0, 1e-6), 1, 0).slew_rate, 83333.333e-6, 1e-15);
  EXPECT_EQ(reference.update(estimate(0, 0, 1e-6), 2, 0).slew_rate, 0);
}

TEST(ChronyReference, OnlyTheFirstUpdatesMayStep) {
  ChronyReference never({});
  EXPECT_FALSE(never.update(estimate(1.5, 0, 1e-6), 0, 0).is_step);
  ChronyReference reference({.step_threshold_s = 1, .step_updates = 3});
  EXPECT_TRUE(reference.update(estimate(1.5, 0, 1e-6), 0, 0).is_step);
  EXPECT_FALSE(reference.update(estimate(1.5, 0, 1e-6), 1, -1).is_step) << "0.5 s are left";
  EXPECT_TRUE(reference.update(estimate(-0.5, 0, 1e-6), 2, -0.6).is_step);
  EXPECT_FALSE(reference.update(estimate(1.5, 0, 1e-6), 3, 0).is_step);
}

TEST(ChronyReference, TheFrequencyIsCapped) {
  ChronyReference reference({});
  EXPECT_NEAR(reference.update(estimate(0, 5e-3, 1e-6), 0, 0).frequency, 5e-3, 1e-8);
  ChronyReference beyond_the_tick({});
  EXPECT_EQ(beyond_the_tick.update(estimate(0, 0.5, 1e-6), 0, 0).frequency, 0.1);
  ChronyReference of_a_frequency_alone({.max_frequency = 500e-6});
  EXPECT_EQ(of_a_frequency_alone.update(estimate(0, 5e-3, 1e-6), 0, 0).frequency, 500e-6);
  EXPECT_EQ(of_a_frequency_alone.update(estimate(0, 5e-3, 1e-6), 0, 0).frequency, 0);
}

TEST(UnfinishedSlew, EndsWhenAllIsAdded) {
  const UnfinishedSlew slew{-1e-3, 100e-6, 50, 10};
  EXPECT_EQ(slew.left_s(40), -1e-3);
  EXPECT_NEAR(slew.left_s(55), -0.5e-3, 1e-15);
  EXPECT_EQ(std::abs(slew.left_s(70)), 0);
  EXPECT_EQ(UnfinishedSlew{}.left_s(10), 0);
  const UnfinishedSlew begun{1e-3, 100e-6, 50, 4};
  EXPECT_NEAR(begun.left_s(1000), 0.6e-3, 1e-15) << "a part of 4 s was begun";
}

TEST(ChronyPoll, GrowsWithTheSamplesOnTheLine) {
  ChronyPoll poll(6, 10, 8);
  // (16/8 - 1)/8 a sample: eight to a step.
  for (int i = 0; i < 7; ++i) poll.update(16, 0, 1e-3);
  EXPECT_EQ(poll.exponent(), 6);
  poll.update(16, 0, 1e-3);
  EXPECT_EQ(poll.exponent(), 7);
  for (int i = 0; i < 1000; ++i) poll.update(64, 0, 1e-3);
  EXPECT_EQ(poll.exponent(), 10);
}

TEST(ChronyPoll, ShrinksTwiceAsFastAndAtOnceWhenThePredictionFails) {
  ChronyPoll poll(6, 10, 8);
  for (int i = 0; i < 1000; ++i) poll.update(64, 0, 1e-3);
  for (int i = 0; i < 8; ++i) poll.update(4, 0, 1e-3);  // -1/8 each, from 1
  EXPECT_EQ(poll.exponent(), 10);
  poll.update(4, 0, 1e-3);
  EXPECT_EQ(poll.exponent(), 9);
  poll.update(8, 5e-3, 1e-3);  // -2.3
  EXPECT_EQ(poll.exponent(), 7);
  poll.update(8, 1, 1e-3);
  EXPECT_EQ(poll.exponent(), 6);
}

TEST(ChronyPoll, BelowASecondOnlyWhereItIsTold) {
  ChronyPoll poll(-2, -2, 8);
  EXPECT_EQ(poll.exponent(), 0) << "nothing is known of the server";
  poll.update(1, 0, 1e-3);
  EXPECT_EQ(poll.interval_s(), 0.25);
  poll.keep_whole_seconds();
  EXPECT_EQ(poll.interval_s(), 1);
}

TEST(ChronyPoll, RepliesThatAreMissingMakeItLonger) {
  ChronyPoll poll(6, 10, 8);
  for (int i = 0; i < 4; ++i) poll.add(0.25);
  EXPECT_EQ(poll.exponent(), 7);
}

}  // namespace
}  // namespace simbench
