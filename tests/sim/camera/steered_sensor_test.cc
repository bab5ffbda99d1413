#include "sim/camera/steered_sensor.h"

#include <gtest/gtest.h>

#include <vector>

namespace simbench::sim {
namespace {

constexpr Nanoseconds kPeriod = std::chrono::milliseconds(30);
constexpr Nanoseconds kExposure = std::chrono::milliseconds(8);

TrueTime at(Nanoseconds since_start) { return TrueTime{} + since_start; }

SteeredSensorSettings settings() {
  SteeredSensorSettings made;
  made.limits = {.frame_length = kPeriod,
                 .shortest = std::chrono::milliseconds(20),
                 .longest = std::chrono::milliseconds(60),
                 .granularity = std::chrono::microseconds(10),
                 .exposure = kExposure,
                 .latency_frames = 2,
                 .allowed = {true, true, true, true}};
  return made;
}

SteeredSensor sensor(const SteeredSensorSettings& of, double skew = 0,
                     Nanoseconds start = Nanoseconds(0)) {
  return SteeredSensor(of, OscillatorModel(skew), RandomStream(1, "sensor", 0), at(start),
                       TrueTime{});
}

std::vector<TrueTime> starts(SteeredSensor& sensor, std::size_t frames,
                             Nanoseconds exposure = kExposure) {
  std::vector<TrueTime> all;
  for (std::size_t i = 0; i < frames; ++i) {
    const TrueTime planned = sensor.next_exposure();
    all.push_back(sensor.expose(exposure).start);
    EXPECT_EQ(all.back(), planned);
  }
  return all;
}

Nanoseconds gap(const std::vector<TrueTime>& starts, std::size_t after) {
  return starts[after + 1] - starts[after];
}

TEST(SteeredSensor, FramesFollowEachOtherByTheCamerasOwnOscillator) {
  SteeredSensor free = sensor(settings(), 100e-6, std::chrono::milliseconds(5));
  const std::vector<TrueTime> all = starts(free, 1001);
  EXPECT_EQ(all.front(), at(std::chrono::milliseconds(5)));
  // 30 s of a clock that is 100 ppm fast take 30 / 1.0001 s.
  EXPECT_NEAR(to_ns(all.back() - all.front()), 30e9 / 1.0001, 1.0);
}

TEST(SteeredSensor, AnExposureEndsWhereItsReadoutBegins) {
  SteeredSensorSettings rolling = settings();
  rolling.readout = std::chrono::milliseconds(16);
  SteeredSensor made = sensor(rolling);
  const Exposure exposure = made.expose(kExposure);
  EXPECT_EQ(exposure.end - exposure.start, kExposure + rolling.readout);
  EXPECT_EQ(exposure.pulse, kNoPulse);
}

TEST(SteeredSensor, AdjustsOneFrameAfterTheLatency) {
  SteeredSensor steered = sensor(settings());
  std::vector<TrueTime> all = starts(steered, 2);
  // Frame 1 is in progress: its readout began at its exposure's end.
  const TrueTime now = all[1] + kExposure + Nanoseconds(1);
  steered.latch({.kind = FrameControlKind::kAdjustFrame, .length = std::chrono::milliseconds(-4)},
                now, now);
  for (const TrueTime start : starts(steered, 4)) all.push_back(start);
  EXPECT_EQ(gap(all, 1), kPeriod);
  EXPECT_EQ(gap(all, 2), kPeriod);
  EXPECT_EQ(gap(all, 3), kPeriod - std::chrono::milliseconds(4));
  EXPECT_EQ(gap(all, 4), kPeriod);
}

TEST(SteeredSensor, LengthsAreWholeGranulesWithinTheLimits) {
  SteeredSensor steered = sensor(settings());
  starts(steered, 1);
  const TrueTime now = steered.next_exposure();
  steered.latch({.kind = FrameControlKind::kFrameLength, .length = Nanoseconds(30'007'000)}, now,
                now);
  const std::vector<TrueTime> longer = starts(steered, 6);
  EXPECT_EQ(gap(longer, 4), Nanoseconds(30'010'000));
  steered.latch({.kind = FrameControlKind::kFrameLength, .length = std::chrono::seconds(1)}, now,
                now);
  const std::vector<TrueTime> longest = starts(steered, 8);
  EXPECT_EQ(gap(longest, 6), settings().limits.longest);
}

TEST(SteeredSensor, AnInsertedFrameExposesLongAndStretchesItsNeighbours) {
  SteeredSensorSettings of_phone = settings();
  of_phone.insert_stretches = 2;
  SteeredSensor steered = sensor(of_phone);
  starts(steered, 1);
  const TrueTime now = steered.next_exposure();
  steered.latch({.kind = FrameControlKind::kInsertFrame, .length = std::chrono::milliseconds(35)},
                now, now);
  TrueTime readout = now;
  Nanoseconds added{};
  Nanoseconds longest_exposure{};
  for (int i = 0; i < 10; ++i) {
    const Exposure made = steered.expose(kExposure);
    if (i > 0) added += made.end - readout - kPeriod;
    readout = made.end;
    longest_exposure = std::max(longest_exposure, made.end - made.start);
  }
  EXPECT_EQ(added, 2 * std::chrono::milliseconds(5));
  EXPECT_EQ(longest_exposure, std::chrono::milliseconds(35) - of_phone.limits.granularity);
}

TEST(SteeredSensor, ALongExposureStretchesTheFrame) {
  SteeredSensorSettings dark = settings();
  dark.limits.exposure = std::chrono::milliseconds(40);
  SteeredSensor steered = sensor(dark);
  const std::vector<TrueTime> all = starts(steered, 5, dark.limits.exposure);
  EXPECT_EQ(gap(all, 3), dark.limits.exposure + dark.limits.granularity);
}

TEST(SteeredSensor, MovesNothingThatIsUnderWay) {
  SteeredSensorSettings quick = settings();
  quick.limits.latency_frames = 1;
  SteeredSensor steered = sensor(quick);
  std::vector<TrueTime> all = starts(steered, 3);
  // Frame 1 is in progress and frame 2 exposed; the next exposure is made already.
  const TrueTime now = all[1] + kExposure;
  const TrueTime planned = steered.next_exposure();
  steered.latch({.kind = FrameControlKind::kAdjustFrame, .length = std::chrono::milliseconds(-9)},
                now, planned);
  EXPECT_EQ(steered.next_exposure(), planned);
  for (const TrueTime start : starts(steered, 2)) all.push_back(start);
  EXPECT_EQ(gap(all, 2), kPeriod);
  EXPECT_EQ(gap(all, 3), kPeriod - std::chrono::milliseconds(9));
}

TEST(SteeredSensor, StartsAtATime) {
  SteeredSensor steered = sensor(settings());
  starts(steered, 3);
  const TrueTime due = at(std::chrono::milliseconds(1234));
  steered.latch({.kind = FrameControlKind::kStartAt, .length = {}, .at = due}, at(kPeriod),
                at(kPeriod));
  EXPECT_EQ(starts(steered, 1).front(), due);
}

TEST(SteeredSensor, AnIdealOneHasItsMiddlesAtTheNearestGranules) {
  SteeredSensorSettings ideal = settings();
  ideal.is_ideal = true;
  ideal.first_due = at(std::chrono::milliseconds(7));
  ideal.period_ns = 30.02e6;  // not a multiple of a granule
  SteeredSensor steered = sensor(ideal, 50e-6, std::chrono::milliseconds(100));
  double slot_before = 0;
  for (int i = 0; i < 1000; ++i) {
    const Exposure made = steered.expose(kExposure);
    const TrueTime middle = made.start + (made.end - made.start) / 2;
    const double since_ns = to_ns(middle - ideal.first_due);
    const double slot = std::round(since_ns / ideal.period_ns);
    EXPECT_LE(std::abs(since_ns - slot * ideal.period_ns), 5'001);
    if (i > 0) {
      EXPECT_EQ(slot, slot_before + 1);
    }
    slot_before = slot;
  }
}

}  // namespace
}  // namespace simbench::sim
