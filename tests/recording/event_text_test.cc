#include "recording/event_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "tests/recording/random_events.h"

namespace simbench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Time>
Time at(std::int64_t ns) {
  return Time(Nanoseconds(ns));
}

std::string line_error(const std::string& line) {
  try {
    from_line(line);
  } catch (const EventTextError& error) {
    return error.what();
  }
  return "no error";
}

TEST(EventTextTest, AFrameWithAndWithoutTruth) {
  FrameEvent frame;
  frame.record = {.camera = 4,
                  .stream = StreamKind::kColour,
                  .domain = StampDomain::kGlobalTime,
                  .counter = 7,
                  .exposure_us = 5000,
                  .sensor = {4294967295},
                  .frame = {2},
                  .backend = at<HostTime>(10),
                  .arrival = at<HostTime>(-11),
                  .arrival_steady = at<SteadyTime>(12)};
  EXPECT_EQ(to_line(frame), "frame,4,colour,global_time,7,5000,4294967295,2,10,-11,12");
  frame.truth = FrameTruth{.pulse = -1,
                           .exposure_start = at<TrueTime>(1),
                           .exposure_end = at<TrueTime>(2),
                           .reference = at<HostTime>(3),
                           .own_host = at<HostTime>(4),
                           .own_steady = at<SteadyTime>(5),
                           .delivered = at<HostTime>(6)};
  EXPECT_EQ(to_line(frame),
            "frame,4,colour,global_time,7,5000,4294967295,2,10,-11,12,-1,1,2,3,4,5,6");
}

TEST(EventTextTest, TheOtherKinds) {
  EXPECT_EQ(to_line(PulseTruth{3, at<TrueTime>(9), {Nanoseconds(0), Nanoseconds(-5)}}),
            "pulse,3,9,0;-5");
  EXPECT_EQ(to_line(PulseTruth{3, at<TrueTime>(9), {}}), "pulse,3,9,");
  EXPECT_EQ(to_line(ClockAdjustment{1, at<SteadyTime>(1), at<HostTime>(2), at<HostTime>(3), 0.1}),
            "adjustment,1,1,2,3,0.1");
  EXPECT_EQ(to_line(DevicePoll{
                5, {77}, at<HostTime>(1), at<HostTime>(2), at<SteadyTime>(3), at<SteadyTime>(4)}),
            "poll,5,77,1,2,3,4");
  EXPECT_EQ(to_line(ExchangeEvent{1, {0, at<HostTime>(1), {}, at<HostTime>(3), {}}}),
            "exchange,1,0,1,,3,");
  EXPECT_EQ(to_line(ExchangeEvent{1, {.peer = 0, .t1 = at<HostTime>(1), .is_estimated = true}}),
            "exchange,1,0,1,,,,estimated");
  EXPECT_EQ(to_line(SyncOutcome{2, false, 200, "a, b\\c\r\nd"}),
            "outcome,2,false,200,a\\, b\\\\c\\r\\nd");
  EXPECT_EQ(to_line(AlignmentReport{7, true, 40, "1.2 ms, late"}),
            "alignment,7,true,40,1.2 ms\\, late");
  EXPECT_EQ(to_line(LedSighting{7, {4294967295}, -1'000'000, 12'000'000}),
            "led,7,4294967295,-1000000,12000000");
  EXPECT_EQ(to_line(SessionDelays{.slave = 2,
                                  .pass = 3,
                                  .begin = at<SteadyTime>(-1),
                                  .end = at<SteadyTime>(9),
                                  .t_l = Nanoseconds(4),
                                  .t_t = Nanoseconds(-5),
                                  .t_d = Nanoseconds(6),
                                  .get = Nanoseconds(7),
                                  .set = Nanoseconds(8)}),
            "delays,2,3,-1,9,4,-5,6,7,8");
  EXPECT_EQ(to_line(ProgramFailure{.host = 2,
                                   .program = "a,b",
                                   .at = Nanoseconds(7),
                                   .how = "exited with status 1",
                                   .last_words = "c\\d",
                                   .log = "e\nf"}),
            "program,2,7,a\\,b,exited with status 1,c\\\\d,e\\nf");
}

TEST(EventTextTest, ReadsBackWhateverWasWritten) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 50'000; ++i) {
    const KeptEvent event = random_event(random);
    const std::string line = to_line(event);
    ASSERT_EQ(line.find_first_of("\n\r"), std::string::npos) << line;
    ASSERT_TRUE(same(from_line(line), event)) << line;
  }
}

// A damaged line is thus either an error or the line of another event, never half-understood.
TEST(EventTextTest, WhatIsReadIsWhatWouldBeWritten) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  const std::string bytes = ",;-+0123456789.eE\\nr \"pulse\0xff";
  int read = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string line = to_line(random_event(random));
    const std::size_t place = random() % line.size();
    switch (random() % 3) {
      case 0:
        line[place] = bytes[random() % bytes.size()];
        break;
      case 1:
        line.insert(place, 1, bytes[random() % bytes.size()]);
        break;
      default:
        line.erase(place, 1 + random() % 3);
    }
    try {
      const KeptEvent event = from_line(line);
      ++read;
      ASSERT_EQ(to_line(event), line);
    } catch (const EventTextError&) {
    }
  }
  EXPECT_GT(read, 1000);  // digits that were changed
}

TEST(EventTextTest, EveryPrefixOfALineIsSafe) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 300; ++i) {
    const std::string line = to_line(random_event(random));
    for (std::size_t size = 0; size < line.size(); ++size) {
      try {
        EXPECT_EQ(to_line(from_line(line.substr(0, size))), line.substr(0, size));
      } catch (const EventTextError&) {
      }
    }
  }
}

TEST(EventTextTest, MessagesNameColumnFoundAndAllowed) {
  EXPECT_EQ(line_error("fraem,1"),
            "column 1 (kind): found 'fraem', allowed: frame, pulse, adjustment, poll, exchange, "
            "outcome, alignment, led, delays, program, pps");
  EXPECT_EQ(line_error("poll,1x,2,3,4,5,6"),
            "column 2 (camera): found '1x', allowed: a whole number from 0 to 4294967295");
  EXPECT_EQ(line_error("poll,1,4294967296,3,4,5,6"),
            "column 3 (device_us): found '4294967296', allowed: a whole number from 0 to "
            "4294967295");
  EXPECT_EQ(line_error("poll,1,2,3"), "column 5 (t1_ns): missing, the line ends before it");
  EXPECT_EQ(line_error("poll,1,2,3,4,5,6,7"), "column 8: found '7', allowed: 7 columns");
  EXPECT_EQ(line_error("frame,0,infrared,hardware_clock,1,1,1,1,1,1,1"),
            "column 3 (stream): found 'infrared', allowed: depth, colour");
  EXPECT_EQ(line_error("outcome,1,yes,0,"),
            "column 3 (synchronised): found 'yes', allowed: true, false");
  EXPECT_EQ(line_error("alignment,1,1,0,"), "column 3 (aligned): found '1', allowed: true, false");
  EXPECT_THAT(line_error("alignment,1,true,3"), HasSubstr("column 5 (message): missing"));
  EXPECT_THAT(line_error("pulse,1,2,3;;4"), HasSubstr("column 4 (error_ns): found '3;;4'"));
  EXPECT_THAT(line_error("pulse,1,2,3;"), HasSubstr("column 4 (error_ns): found '3;'"));
  EXPECT_THAT(line_error("exchange,1,0,1,2,3"), HasSubstr("column 7 (t4_ns): missing"));
  EXPECT_THAT(
      line_error("exchange,1,0,1,2,3,4,guessed"),
      HasSubstr("column 8 (estimated): found 'guessed', allowed: \"estimated\" or nothing"));
  EXPECT_THAT(line_error("exchange,1,0,1,2,3,4,estimated,5"), HasSubstr("column 9"));
  EXPECT_THAT(line_error("delays,1,1,0,0,1,2,3,4"), HasSubstr("column 10 (set_ns): missing"));
  EXPECT_THAT(line_error("delays,1,1,0,0,1.5,2,3,4,5"),
              HasSubstr("column 6 (t_l_ns): found '1.5', allowed: a whole number from"));
  EXPECT_THAT(line_error(""), HasSubstr("column 1 (kind): found ''"));
}

TEST(EventTextTest, NumbersHaveOneWayToBeWritten) {
  for (const char* number : {"01", "-0", "+1", " 1", "1 ", "0x1", "1.0", "1e3", "", "-",
                             "9223372036854775808", "-9223372036854775809"}) {
    EXPECT_THAT(line_error(std::string("poll,1,2,") + number + ",4,5,6"),
                HasSubstr("column 4 (t0_ns)"));
  }
  for (const char* number : {"nan", "inf", "-inf", "1e400", "0.10", "1.", ".5", "00", "+1", ""}) {
    EXPECT_THAT(line_error(std::string("adjustment,1,2,3,4,") + number),
                HasSubstr("column 6 (rate_ppb)"));
  }
}

TEST(EventTextTest, TextsHaveOneWayToBeWritten) {
  EXPECT_THAT(line_error("outcome,1,true,0,a,b"), HasSubstr("column 5 (message): found 'a,b'"));
  EXPECT_THAT(line_error("outcome,1,true,0,a\nb"),
              HasSubstr("column 5 (message): found 'a\\x0ab'"));
  EXPECT_THAT(line_error("outcome,1,true,0,a\\"), HasSubstr("after a backslash"));
  EXPECT_THAT(line_error("outcome,1,true,0,a\\t"), HasSubstr("after a backslash"));
}

TEST(EventTextTest, AMessageStaysShortAndPrintable) {
  const std::string text = line_error("poll," + std::string(100'000, '\xff'));
  EXPECT_LT(text.size(), 300U);
  EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
}

}  // namespace
}  // namespace simbench
