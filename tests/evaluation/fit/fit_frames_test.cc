// What a fit uses of recordings that no line fits as they are.
#include "evaluation/fit/fit_frames.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "evaluation/fit/fit.h"
#include "evaluation/fit/fit_input.h"
#include "sim/engine/random.h"

namespace simbench::evaluation {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kFramesPeriodMs = 33.3;

// A camera that is 40 ppm fast, with frames 20 ms and delay_ms(i) late, in order of delivery.
RecordedStream fit_recording(int count, const std::function<double(int)>& delay_ms,
                             double period_ms = kFramesPeriodMs, double begin_ms = 500) {
  RecordedStream stream{.camera = "a", .host = "pc", .stream = "depth", .frames = {}};
  for (int i = 0; i < count; ++i) {
    const double t_ms = i * period_ms;
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(i),
                             .sensor = from_ms(begin_ms + t_ms * (1 + 40e-6)),
                             .arrival = from_ms(t_ms + 20 + delay_ms(i))});
  }
  std::ranges::stable_sort(stream.frames, {}, &StampedFrame::arrival);
  return stream;
}

// Up to 1 ms late.
std::function<double(int)> jitter(sim::RandomStream& random) {
  return [&random](int) { return random.uniform(); };
}

void expect_rate(const RigFit& fit, double ppm) {
  const FittedValue found = fit.skew_ppm.at(0).value();
  EXPECT_NEAR(found.value, ppm, 5 * found.error);
  EXPECT_LT(found.error, 30);  // of 10 s and some
}

TEST(FitFrames, AStallLongerThanAPeriodIsLateFramesOutOfOrder) {
  sim::RandomStream random(1, "test");
  const RecordedStream stream =
      fit_recording(500, [&](int i) { return random.uniform() + (i == 200 ? 35 : 0); });
  ASSERT_GT(stream.frames[200].counter, stream.frames[201].counter);
  const FitInput input = fit_input({stream}, false);
  ASSERT_THAT(input.streams, SizeIs(1));
  EXPECT_THAT(input.left_out, ElementsAre(HasSubstr("the first quarter (125 frames)")));
  EXPECT_EQ(input.streams[0].account.lost, 0);
  EXPECT_EQ(input.streams[0].account.counter_restarts, 0);
  const RigFit fit = fit_rig(input);
  expect_rate(fit, 40);
  EXPECT_NEAR(fit.excess_ms.back(), 35.5, 0.6);
  EXPECT_THAT(fit.left_out, Contains(HasSubstr("the order of 1 frame that came more than")));
}

// A second of frames that are held and then come at once: 30 late frames are no jump.
TEST(FitFrames, AStallOfASecondIsNoStep) {
  sim::RandomStream random(2, "test");
  const auto delay_ms = [&](int i) {
    const double held_ms = i >= 300 && i < 330 ? (330 - i) * kFramesPeriodMs : 0;
    return random.uniform() + held_ms;
  };
  const FitInput input = fit_input({fit_recording(590, delay_ms)}, false);
  EXPECT_THAT(input.streams.at(0).frames, SizeIs(443));
  expect_rate(fit_rig(input), 40);
}

TEST(FitFrames, AClockThatIsSetCutsTheStream) {
  sim::RandomStream random(3, "test");
  const auto delay_ms = [&](int i) { return random.uniform() + (i >= 400 ? 250 : 0); };
  const FitInput input = fit_input({fit_recording(590, delay_ms)}, false);
  EXPECT_THAT(input.streams.at(0).frames, SizeIs(300));
  EXPECT_EQ(input.streams[0].account.delivered, 590);
  EXPECT_THAT(input.left_out, Contains(HasSubstr("190 frames after 13.3 s")));
  EXPECT_THAT(input.left_out, Contains(HasSubstr("once (+250.")));
  expect_rate(fit_rig(input), 40);
}

TEST(FitFrames, ARestartCutsTheStream) {
  sim::RandomStream random(4, "test");
  RecordedStream stream = fit_recording(200, jitter(random));
  const RecordedStream again = fit_recording(350, jitter(random), kFramesPeriodMs, 100);
  for (StampedFrame frame : again.frames) {
    frame.arrival += from_ms(9000);
    stream.frames.push_back(frame);
  }
  const FitInput input = fit_input({stream}, false);
  EXPECT_THAT(input.streams.at(0).frames, SizeIs(350));
  EXPECT_THAT(input.left_out, Contains(HasSubstr("200 frames before 9.0 s")));
  expect_rate(fit_rig(input), 40);
}

TEST(FitFrames, AnUnsteadyStartDoesNotTurnTheLine) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "test");
    const auto delay_ms = [&](int i) { return random.uniform() + (i < 30 ? 30.0 - i : 0); };
    const FitInput input = fit_input({fit_recording(300, delay_ms)}, false);
    EXPECT_THAT(input.streams.at(0).frames, SizeIs(225)) << "seed " << seed;
    EXPECT_THAT(input.left_out, ElementsAre(HasSubstr("the first quarter (75 frames)")));
    const FittedValue found = fit_rig(input).skew_ppm.at(0).value();
    EXPECT_NEAR(found.value, 40, 5 * found.error) << "seed " << seed;
    EXPECT_LT(found.error, 40) << "seed " << seed;
  }
}

TEST(FitFrames, LongRecordingsLoseTheirFirstSeconds) {
  sim::RandomStream random(6, "test");
  const FitInput input = fit_input({fit_recording(900, jitter(random))}, false);
  EXPECT_NEAR(static_cast<double>(input.streams.at(0).frames.size()), 750, 2);
  EXPECT_THAT(input.left_out, ElementsAre(HasSubstr("the first 5 s (")));
}

TEST(FitFrames, RepeatedStampsAreDropped) {
  sim::RandomStream random(7, "test");
  RecordedStream stream = fit_recording(300, jitter(random));
  stream.frames.insert(stream.frames.begin() + 150, stream.frames[149]);
  const FitInput input = fit_input({stream}, false);
  EXPECT_THAT(input.left_out,
              Contains(HasSubstr("camera a, depth: 1 frame with the device stamp of another")));
}

TEST(FitFrames, FastAndEpochStampsAndAVaryingRateAreFitted) {
  sim::RandomStream random(8, "test");
  expect_rate(fit_rig(fit_input({fit_recording(3000, jitter(random), 5)}, false)), 40);
  expect_rate(
      fit_rig(fit_input({fit_recording(590, jitter(random), kFramesPeriodMs, 1.7e12)}, false)), 40);
  RecordedStream varying = fit_recording(590, [](int) { return 0.0; });
  double off_ms = 0;
  for (std::size_t i = 0; i < varying.frames.size(); ++i) {
    off_ms += i % 100 < 40 ? 12 : 0;  // a longer exposure
    varying.frames[i].sensor += from_ms(off_ms * (1 + 40e-6));
    varying.frames[i].arrival += from_ms(off_ms + random.uniform());
  }
  const RigFit fit = fit_rig(fit_input({varying}, false));
  expect_rate(fit, 40);
  EXPECT_THAT(fit.left_out, Contains(HasSubstr("a rate that varies")));
}

TEST(FitFrames, AStreamThatIsTooShortIsLeftOut) {
  sim::RandomStream random(9, "test");
  RecordedStream shorter = fit_recording(60, jitter(random));
  shorter.stream = "colour";
  const RigFit fit = fit_rig(fit_input({fit_recording(400, jitter(random)), shorter}, false));
  EXPECT_THAT(fit.streams, SizeIs(1));
  EXPECT_THAT(fit.left_out, Contains(HasSubstr("camera a, colour: all of it, ")));
  expect_rate(fit, 40);
}

TEST(LostTogether, IsTheLengthOfTheGapThatALostFrameIsIn) {
  std::vector<StampedFrame> frames;
  for (std::uint64_t i = 0; i < 100; ++i) {
    if ((i >= 20 && i < 24) || i == 50) continue;
    const auto at = from_ms(static_cast<double>(i) * kFramesPeriodMs);
    frames.push_back({.counter = i, .sensor = at, .arrival = at});
  }
  EXPECT_DOUBLE_EQ(lost_together(frames, true), (16 + 1) / 5.0);
  EXPECT_DOUBLE_EQ(lost_together(frames, false), 1);
}

}  // namespace
}  // namespace simbench::evaluation
