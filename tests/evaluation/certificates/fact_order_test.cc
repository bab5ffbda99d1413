#include "evaluation/certificates/fact_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "evaluation/certificates/capture_evidence.h"

namespace simbench::evaluation {
namespace {

using std::chrono::seconds;

using testing::HasSubstr;

constexpr int kExchanges = 1200;
constexpr seconds kBack{60};

// An exchange a second of two hosts whose steady clocks agree. The system clock of host 1 is set
// back by a minute after one, so that it reads what it read in that minute once more; the exchanges
// are reported afterwards.
CaptureEvidence clock_set_back() {
  CaptureEvidence evidence({}, StreamKind::kDepth);
  evidence.on_start({.hosts = 2, .cameras = {{0}, {1}}});
  for (const std::uint32_t host : {0U, 1U}) {
    evidence.on_event(ClockAdjustment{host, {}, {}, {}, 0});
  }
  evidence.on_event(ClockAdjustment{1, SteadyTime(kBack), HostTime(kBack), HostTime(), 0});
  for (int i = 0; i < kExchanges; ++i) {
    const seconds now(i);
    const HostTime own(now < kBack ? now : now - kBack);
    const HostTime peer = HostTime(now) + std::chrono::microseconds(100);
    evidence.on_event(ExchangeEvent{1,
                                    {.peer = 0,
                                     .t1 = own,
                                     .t2 = peer,
                                     .t3 = peer,
                                     .t4 = own + std::chrono::microseconds(200)}});
  }
  return evidence;
}

// Stamps that were read twice say little, and the order does not follow them: the points of all
// other exchanges are neighbours.
TEST(FactOrder, StampsThatAClockReadTwiceDoNotDecideTheOrder) {
  const CaptureEvidence evidence = clock_set_back();
  const FactOrder order(evidence);
  ASSERT_EQ(order.facts().size(), 2U * kExchanges);
  const auto far = std::ranges::count_if(
      order.facts(), [](const ClockFact& fact) { return fact.later() - fact.earlier() > 8; });
  EXPECT_GT(far, 0);
  EXPECT_LE(far, 2 * 2 * kBack.count());
}

// Two quartzes 100 ppm apart, ten exchanges a second for an hour: after it they are 360 ms apart,
// and the points of an exchange are neighbours still.
TEST(FactOrder, FollowsTheClocksDrift) {
  CaptureEvidence evidence({}, StreamKind::kDepth);
  evidence.on_start({.hosts = 2, .cameras = {{0}, {1}}});
  for (const std::uint32_t host : {0U, 1U}) {
    evidence.on_event(ClockAdjustment{host, {}, {}, {}, 0});
  }
  for (int i = 0; i < 36'000; ++i) {
    const HostTime own(std::chrono::milliseconds(100) * i);
    const HostTime peer = own + std::chrono::microseconds(100) + std::chrono::microseconds(10) * i;
    evidence.on_event(ExchangeEvent{1,
                                    {.peer = 0,
                                     .t1 = own,
                                     .t2 = peer,
                                     .t3 = peer,
                                     .t4 = own + std::chrono::microseconds(200)}});
  }
  const FactOrder order(evidence);
  for (const ClockFact& fact : order.facts()) ASSERT_LE(fact.later() - fact.earlier(), 4U);
}

CaptureEvidence one_frame() {
  CaptureEvidence evidence({}, StreamKind::kDepth);
  evidence.on_start({.hosts = 1, .cameras = {{0}}});
  FrameRecord frame;
  frame.sensor = {100'000};
  evidence.on_frame(frame, nullptr);
  return evidence;
}

const char* refused_text(const CaptureEvidence& evidence, std::string& text) {
  try {
    const FactOrder order(evidence);
  } catch (const NotCertifiable& problem) {
    text = problem.what();
  }
  return text.c_str();
}

// A clock whose stamps are months apart, and stamps that no clock counts, near the ends of 64 bits.
TEST(FactOrder, BrokenStampsAreRefusedByName) {
  std::string text;
  CaptureEvidence evidence = one_frame();
  EXPECT_STREQ(refused_text(evidence, text), "");
  FrameRecord late;
  late.sensor = {200'000};
  late.arrival_steady = SteadyTime(std::chrono::hours(24 * 19));
  evidence.on_frame(late, nullptr);
  EXPECT_STREQ(refused_text(evidence, text), "");
  late.arrival_steady = SteadyTime(std::chrono::hours(24 * 21));
  evidence.on_frame(late, nullptr);
  EXPECT_THAT(refused_text(evidence, text),
              HasSubstr("stamps of host 0's clock from 0 to 1.8144e+06 s"));
}

TEST(FactOrder, StampsThatNoClockCountsAreRefusedByName) {
  for (const Nanoseconds end : {Nanoseconds::max(), Nanoseconds::min()}) {
    const auto refused = [&](const RecordingEvent& event, const char* where) {
      CaptureEvidence evidence = one_frame();
      evidence.on_event(ClockAdjustment{0, {}, {}, {}, 0});
      evidence.on_event(event);
      std::string text;
      EXPECT_THAT(refused_text(evidence, text), HasSubstr(where));
    };
    refused(ClockAdjustment{0, SteadyTime(end), {}, {}, 0}, "found an adjustment of host 0 with");
    refused(ClockAdjustment{0, {}, {}, HostTime(end), 0}, "an adjustment of host 0");
    refused(DevicePoll{0, {1}, {}, {}, SteadyTime(end), SteadyTime(end)}, "a poll of camera 0");
    refused(ExchangeEvent{0, {.peer = 0, .t1 = HostTime(end)}}, "an exchange of host 0");
    CaptureEvidence evidence = one_frame();
    FrameRecord frame;
    frame.arrival_steady = SteadyTime(end);
    evidence.on_frame(frame, nullptr);
    std::string text;
    EXPECT_THAT(refused_text(evidence, text), HasSubstr("a frame of camera 0"));
  }
}

}  // namespace
}  // namespace simbench::evaluation
