#include "clocks/frame_lengths.h"

#include <gmock/gmock.h>

namespace simbench::clocks {
namespace {

using Kind = FrameControlKind;
using testing::HasSubstr;

constexpr Nanoseconds kUsual = std::chrono::milliseconds(30);

FrameControlLimits limits() {
  return {.frame_length = kUsual,
          .shortest = std::chrono::milliseconds(20),
          .longest = std::chrono::milliseconds(60),
          .granularity = std::chrono::microseconds(10),
          .exposure = std::chrono::milliseconds(8),
          .latency_frames = 2,
          .allowed = {true, true, true, true}};
}

void control(FrameLengths& lengths, Kind kind, Nanoseconds value, std::int64_t frame) {
  lengths.set(kind, lengths.wanted(kind, value, frame), frame);
}

TEST(FrameLengths, AnAdjustedFrameIsLongerByTheNearestGranuleAndTheNextIsAsBefore) {
  FrameLengths lengths(limits());
  control(lengths, Kind::kAdjustFrame, from_us(1234), 5);
  EXPECT_EQ(lengths.of(4), kUsual);
  EXPECT_EQ(lengths.of(5), kUsual + from_us(1230));
  EXPECT_EQ(lengths.of(6), kUsual);
  EXPECT_EQ(lengths.exposure(6), std::nullopt);
}

TEST(FrameLengths, AFrameLengthStaysAndAdjustmentsCountFromIt) {
  FrameLengths lengths(limits());
  control(lengths, Kind::kFrameLength, from_ms(40), 5);
  control(lengths, Kind::kAdjustFrame, from_ms(-3), 7);
  EXPECT_EQ(lengths.of(4), kUsual);
  for (const std::int64_t frame : {5, 6, 8, 1000}) EXPECT_EQ(lengths.of(frame), from_ms(40));
  EXPECT_EQ(lengths.of(7), from_ms(37));
}

TEST(FrameLengths, AnInsertedFrameStretchesAndIsExposedForItsLengthLessAGranule) {
  FrameLengths lengths(limits(), 2);
  const Nanoseconds wanted = lengths.wanted(Kind::kInsertFrame, from_ms(50), 5);
  lengths.set(Kind::kInsertFrame, wanted, 5);
  lengths.lengthen(6, from_us(7));
  EXPECT_EQ(lengths.of(5), from_ms(50));
  EXPECT_EQ(lengths.of(6), from_ms(50) + from_us(7));
  EXPECT_EQ(lengths.of(7), kUsual);
  EXPECT_EQ(lengths.exposure(6), from_ms(50) - from_us(10));
  EXPECT_EQ(lengths.exposure(7), std::nullopt);
}

TEST(FrameLengths, WhatIsForgottenChangesNoLaterFrame) {
  FrameLengths lengths(limits());
  control(lengths, Kind::kFrameLength, from_ms(40), 5);
  control(lengths, Kind::kAdjustFrame, from_ms(1), 9);
  lengths.forget_before(9);
  EXPECT_EQ(lengths.of(9), from_ms(41));
  EXPECT_EQ(lengths.of(10), from_ms(40));
}

TEST(FrameRequests, TheReplyHasTheLengthOfTheFrame) {
  FrameRequests requests(limits());
  EXPECT_EQ(requests.reply(Kind::kAdjustFrame, from_us(-1234)).length, kUsual - from_us(1230));
  EXPECT_EQ(requests.reply(Kind::kFrameLength, from_ms(40)).length, from_ms(40));
  EXPECT_EQ(requests.reply(Kind::kAdjustFrame, from_ms(1)).length, from_ms(41));
  EXPECT_EQ(requests.reply(Kind::kInsertFrame, from_ms(50)).length, from_ms(50));
  EXPECT_TRUE(requests.reply(Kind::kStartAt, {}).is_accepted());
}

TEST(FrameRequests, WhatIsRefusedChangesNothing) {
  FrameRequests requests(limits());
  EXPECT_THAT(requests.reply(Kind::kFrameLength, from_ms(61)).refused, HasSubstr("20"));
  EXPECT_THAT(requests.reply(Kind::kAdjustFrame, from_ms(-11)).refused, HasSubstr("19"));
  EXPECT_EQ(requests.reply(Kind::kAdjustFrame, from_ms(1)).length, kUsual + from_ms(1));
  FrameControlLimits fixed = limits();
  fixed.allowed = {};
  EXPECT_THAT(FrameRequests(fixed).reply(Kind::kStartAt, {}).refused, HasSubstr("start_at"));
}

}  // namespace
}  // namespace simbench::clocks
