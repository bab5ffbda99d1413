// What recordings of real rigs show, each rebuilt from its fault: absolute stamps, grids, causes.
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"

namespace simbench::evaluation {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kEpochMs = 1'700'000'000'000;

// A camera whose stamps count from 1970 (or from `zero_ms`), with a computer that records them.
struct EpochCamera {
  std::string name;
  double period_ms = 1000.0 / 30;
  double phase_ms = 0;
  double zero_ms = kEpochMs;
  double recorder_zero_ms = kEpochMs;
  double stamp_sd_ms = 0.02;
  double delay_ms = 30;
  double delay_sd_ms = 1;
  double program_ms = -1;  // stamped so long before the arrival, in place of the exposure
  int frames = 3600;
  std::uint32_t seed = 1;
  bool counted = true;
};

RecordedStream epoch_stream(const EpochCamera& camera) {
  boost::random::mt19937 random(camera.seed + static_cast<std::uint32_t>(camera.name[0]));
  boost::random::normal_distribution<double> normal;
  RecordedStream stream{.camera = camera.name, .host = "rig", .stream = "frame", .frames = {}};
  stream.counted = camera.counted;
  for (int i = 0; i < camera.frames; ++i) {
    const double at_ms = camera.phase_ms + i * camera.period_ms;
    const double arrival_ms = at_ms + camera.delay_ms + camera.delay_sd_ms * normal(random);
    const double noise_ms = camera.stamp_sd_ms * normal(random);
    const double stamp_ms =
        camera.program_ms >= 0 ? arrival_ms - camera.program_ms + noise_ms : at_ms + noise_ms;
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(i),
                             .sensor = from_ms(stamp_ms) + from_ms(camera.zero_ms),
                             .arrival = from_ms(arrival_ms) + from_ms(camera.recorder_zero_ms)});
  }
  return stream;
}

// Stamps of a clock that counts from when the camera was switched on.
RecordedStream record_own_clock(const std::string& name, double ppm, std::uint32_t seed) {
  RecordedStream stream = epoch_stream({.name = name, .delay_sd_ms = 0.3, .seed = seed});
  const Nanoseconds begin = stream.frames.front().sensor;
  for (StampedFrame& frame : stream.frames) {
    frame.sensor = from_ms(7000.0 * seed + to_ms(frame.sensor - begin) * (1 + ppm * 1e-6));
  }
  return stream;
}

std::vector<std::string> named_kinds(const Diagnosis& diagnosis) {
  std::vector<std::string> all;
  for (const Finding& finding : diagnosis.findings) {
    all.push_back(finding.camera + " " + finding.kind);
  }
  return all;
}

const CameraDiagnosis& diagnosed_camera(const Diagnosis& diagnosis, const std::string& name) {
  return *std::ranges::find(diagnosis.cameras, name, &CameraDiagnosis::camera);
}

TEST(Evidence, TaiAndUtcAre37SecondsApart) {
  const Diagnosis found = diagnose(
      {epoch_stream({.name = "blaze", .period_ms = 50}),
       epoch_stream(
           {.name = "ace", .period_ms = 50, .phase_ms = 45, .zero_ms = kEpochMs + 37'000})},
      {});
  ASSERT_FALSE(found.findings.empty());
  EXPECT_EQ(named_kinds(found).front(), "ace time_scale");
  EXPECT_THAT(found.findings.front().text, HasSubstr("count TAI, which is 37 s ahead of UTC"));
  EXPECT_EQ(diagnosed_camera(found, "ace").scale.shift_s, 37);
  // A median of the normal delay.
  EXPECT_NEAR(diagnosed_camera(found, "ace").scale.delay_ms, 30, 0.2);
  EXPECT_EQ(diagnosed_camera(found, "blaze").scale.kind, ScaleKind::kUnixTime);
  // With that taken out they are 5 ms apart, of a period of 50 ms.
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorksWithOffset) << found.verdict.reason;
  EXPECT_TRUE(found.verdict.by_stamps);
  EXPECT_NEAR(diagnosed_camera(found, "ace").standing.phase_ms, -5, 0.01);
  EXPECT_THAT(named_kinds(found), Contains("ace constant_offset"));
}

TEST(Evidence, ConstantsBetweenScalesHaveNames) {
  const struct {
    double ahead_s;
    const char* name;
  } cases[] = {{37, "TAI"},
               {-37, "UTC, while the others count TAI"},
               {18, "GPS time, which is 18 s"},
               {-18, "UTC, while the others count GPS"},
               {7200, "local time, 2 h ahead"},
               {-18'000, "local time, 5 h behind"},
               {20'700, "local time, 5.75 h ahead"},
               {2'082'844'800, "1904"},
               {-946'684'800, "2000"},
               {-315'964'782, "GPS seconds from 1980"},
               {1, "1 whole second ahead"},
               {-23, "23 whole seconds behind"}};
  for (const auto& [ahead_s, name] : cases) {
    const Diagnosis found =
        diagnose({epoch_stream({.name = "a"}),
                  epoch_stream({.name = "b", .zero_ms = kEpochMs + ahead_s * 1e3})},
                 {});
    ASSERT_FALSE(found.findings.empty()) << name;
    EXPECT_EQ(named_kinds(found).front(), "b time_scale") << name;
    EXPECT_THAT(found.findings.front().text, HasSubstr(name));
    EXPECT_EQ(diagnosed_camera(found, "b").scale.shift_s, ahead_s);
    EXPECT_EQ(diagnosed_camera(found, "a").scale.kind, ScaleKind::kUnixTime);
  }
}

TEST(Evidence, AClockAheadThatHasNoNameAndOneFarBehind) {
  const Diagnosis ahead = diagnose(
      {epoch_stream({.name = "a"}), epoch_stream({.name = "b", .zero_ms = kEpochMs + 400})}, {});
  EXPECT_EQ(named_kinds(ahead).front(), "b clock_ahead");
  // 1 % of normal delays are below 30 - 2.33 sd.
  EXPECT_NEAR(diagnosed_camera(ahead, "b").scale.least_delay_ms, 30 - 2.33 - 400, 0.5);
  const Diagnosis behind = diagnose(
      {epoch_stream({.name = "a"}), epoch_stream({.name = "b", .zero_ms = kEpochMs - 7'400})}, {});
  EXPECT_EQ(named_kinds(behind).front(), "b clock_behind");
}

// The recorder's clock counts from its start: the cameras are compared with each other.
TEST(Evidence, CamerasOnOneEpochAreComparedWithEachOther) {
  const Diagnosis found = diagnose(
      {epoch_stream({.name = "a", .recorder_zero_ms = 5000}),
       epoch_stream(
           {.name = "b", .phase_ms = 10, .zero_ms = kEpochMs + 37'000, .recorder_zero_ms = 5000})},
      {});
  EXPECT_EQ(named_kinds(found).front(), "b time_scale");
  EXPECT_NEAR(diagnosed_camera(found, "b").standing.phase_ms, 10, 0.01);
}

TEST(Evidence, AStampOfAProgramIsNoStampOfASensor) {
  const Diagnosis found =
      diagnose({epoch_stream({.name = "oak", .delay_ms = 48, .delay_sd_ms = 2.5}),
                epoch_stream({.name = "arducam",
                              .phase_ms = 7,
                              .stamp_sd_ms = 0.06,
                              .delay_ms = 110,
                              .delay_sd_ms = 4,
                              .program_ms = 0.48})},
               {});
  EXPECT_EQ(named_kinds(found).front(), "arducam stamped_on_arrival");
  EXPECT_NEAR(diagnosed_camera(found, "arducam").scale.delay_ms, 0.48, 0.01);
  EXPECT_NEAR(diagnosed_camera(found, "arducam").facts.delay.scatter_ms, 0.06, 0.01);
  EXPECT_EQ(diagnosed_camera(found, "arducam").facts.missing(), 0) << "its counter has no gap";
  EXPECT_THAT(named_kinds(found), Not(Contains("oak stamped_on_arrival")));
  EXPECT_THAT(named_kinds(found), Not(Contains("arducam constant_offset")));
}

// A reader takes every other frame of 60 Hz: the even ones, the odd ones, the even ones again.
TEST(Evidence, AnOffsetThatFlipsByHalfAPeriodIsNoDrift) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "left"}),
                                         epoch_stream({.name = "right"})};
  constexpr double kHalfMs = 500.0 / 30;
  for (int i = 0; i < 3600; ++i) {
    const bool odd = i < 700 || i >= 2500;
    StampedFrame& frame = streams[1].frames[static_cast<std::size_t>(i)];
    frame.sensor += from_ms(odd ? kHalfMs : 0);
    frame.arrival += from_ms(odd ? kHalfMs : 0);
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kSlips) << found.verdict.reason;
  const Standing& right = diagnosed_camera(found, "right").standing;
  EXPECT_NEAR(right.rate_ppm, 0, 0.5);
  ASSERT_EQ(right.segments.size(), 3U);
  EXPECT_NEAR(right.segments[0].phase_ms, kHalfMs, 0.05);
  EXPECT_NEAR(right.segments[1].phase_ms, 0, 0.05);
  EXPECT_NEAR(right.segments[2].phase_ms, kHalfMs, 0.05);
  EXPECT_NEAR(right.segments[1].from_s, 700 / 30.0, 0.1);
  EXPECT_NEAR(right.segments[2].from_s, 2500 / 30.0, 0.1);
  EXPECT_EQ(diagnosed_camera(found, "right").facts.missing(), 0);
  EXPECT_THAT(named_kinds(found), Contains("right phase_step"));
  EXPECT_THAT(named_kinds(found), Not(Contains("left phase_step"))) << "the camera that changed";
  EXPECT_THAT(found.verdict.reason, HasSubstr("half a period"));
}

TEST(Evidence, AConstantHalfPeriodIsNamed) {
  const Diagnosis found = diagnose(
      {epoch_stream({.name = "left"}), epoch_stream({.name = "right", .phase_ms = 500.0 / 30})},
      {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorksWithOffset);
  EXPECT_THAT(found.verdict.reason,
              HasSubstr("camera right is 16.7 ms later than camera left (half "
                        "a period)"));
  const Diagnosis none =
      diagnose({epoch_stream({.name = "left"}), epoch_stream({.name = "right"})}, {});
  EXPECT_EQ(none.verdict.status, SyncStatus::kWorks);
  EXPECT_THAT(none.findings, IsEmpty());
  EXPECT_LT(none.verdict.spread_ms, 0.005);
}

// Whatever is dropped, the frames that are left lie on the grid of the others.
TEST(Evidence, AReaderThatDropsMostFramesIsStillSynchronised) {
  for (const double dropped : {0.02, 0.2, 0.55, 0.8}) {
    for (const bool counted : {true, false}) {
      std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}),
                                             epoch_stream({.name = "b", .counted = counted})};
      boost::random::mt19937 random(7);
      boost::random::uniform_01<double> uniform;
      std::erase_if(streams[1].frames,
                    [&](const StampedFrame&) { return uniform(random) < dropped; });
      const Diagnosis found = diagnose(streams, {});
      EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << dropped << found.verdict.reason;
      const CameraDiagnosis& b = diagnosed_camera(found, "b");
      EXPECT_EQ(b.standing.period_multiple, 1) << dropped;
      EXPECT_NEAR(b.facts.missing_share(), dropped, 0.02);
      EXPECT_EQ(named_kinds(found).front(), counted ? "b lost_frames" : "b missing_frames");
    }
  }
}

TEST(Evidence, EveryOtherFrameDroppedByAReaderIsCounted) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}), epoch_stream({.name = "b"})};
  std::erase_if(streams[1].frames, [](const StampedFrame& f) { return f.counter % 2 == 1; });
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(diagnosed_camera(found, "b").standing.period_multiple, 2);
  EXPECT_NEAR(diagnosed_camera(found, "b").facts.missing_share(), 0.5, 0.01);
  EXPECT_THAT(named_kinds(found), Contains("b divided_rate"));
}

TEST(Evidence, HalfAMinuteShows5000Ppm) {
  const Diagnosis found = diagnose(
      {epoch_stream({.name = "a", .delay_sd_ms = 3, .frames = 900}),
       epoch_stream(
           {.name = "b", .period_ms = 1000.0 / 30 * 1.005, .delay_sd_ms = 3, .frames = 900})},
      {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork) << found.verdict.reason;
  EXPECT_NEAR(std::abs(diagnosed_camera(found, "b").standing.rate_ppm), 5000, 30);
}

TEST(Evidence, WhereFramesAreMissing) {
  const auto pattern = [](auto is_missing) {
    std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}),
                                           epoch_stream({.name = "b"})};
    std::erase_if(streams[1].frames, [&](const StampedFrame& f) { return is_missing(f.counter); });
    return diagnosed_camera(diagnose(streams, {}), "b").facts.losses;
  };
  EXPECT_EQ(pattern([](std::uint64_t n) { return n > 5 && n < 100 && n % 4 == 0; }).pattern,
            LossPattern::kAtStart);
  const LossPlaces even = pattern([](std::uint64_t n) { return n % 60 == 30; });
  EXPECT_EQ(even.pattern, LossPattern::kPeriodic);
  EXPECT_NEAR(even.every_s, 2, 0.01);
  EXPECT_EQ(pattern([](std::uint64_t n) { return n * 2654435761U % 4096 < 80; }).pattern,
            LossPattern::kRandom);
}

TEST(Evidence, ARateThatChangesIsNamed) {
  for (const double factor : {0.5, 0.98, 0.9995}) {
    RecordedStream changing = epoch_stream({.name = "b"});
    const std::vector<StampedFrame> before = changing.frames;
    for (std::size_t i = 1800; i < 3600; ++i) {
      const auto stretch = [&](Nanoseconds StampedFrame::*stamp) {
        return before[1800].*stamp +
               from_ms(to_ms(before[i].*stamp - before[1800].*stamp) / factor);
      };
      changing.frames[i].sensor = stretch(&StampedFrame::sensor);
      changing.frames[i].arrival = stretch(&StampedFrame::arrival);
    }
    const Diagnosis found = diagnose({epoch_stream({.name = "a", .frames = 5400}), changing}, {});
    const std::vector<RateChange>& changes = diagnosed_camera(found, "b").facts.rate_changes;
    ASSERT_EQ(changes.size(), 1U) << factor;
    EXPECT_NEAR(changes[0].at_s, 60, 8) << factor;
    EXPECT_NEAR(changes[0].to_hz / changes[0].from_hz, factor, 2e-4);
    EXPECT_THAT(named_kinds(found), Contains("b rate_change"));
    EXPECT_THAT(named_kinds(found), Not(Contains("a rate_change")));
  }
}

TEST(Evidence, ExposuresAreLookedAt) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}), epoch_stream({.name = "b"}),
                                         epoch_stream({.name = "c"})};
  for (std::size_t i = 0; i < 3600; ++i) {
    streams[0].columns.exposure_us.push_back(8000);
    streams[0].columns.temperature_c.push_back(30 + static_cast<double>(i) / 400);
    streams[1].columns.temperature_c.push_back(40);
    streams[1].columns.exposure_us.push_back(2000 + static_cast<double>(i));  // to 5.6 ms
    streams[2].columns.exposure_us.push_back(40'000);
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_THAT(named_kinds(found), Contains("a temperature"));
  EXPECT_THAT(named_kinds(found), Not(Contains("b temperature")));
  EXPECT_THAT(named_kinds(found), Contains("b auto_exposure"));
  EXPECT_THAT(named_kinds(found), Contains("c exposure_too_long"));
  EXPECT_THAT(named_kinds(found), Contains("c exposures_differ"));
  EXPECT_THAT(named_kinds(found), Not(Contains("a auto_exposure")));
}

TEST(Evidence, ABackEndStampTellsTheLinkFromTheProgram) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a", .delay_sd_ms = 6}),
                                         epoch_stream({.name = "b", .delay_sd_ms = 6})};
  // The driver had a's frames 29 ms after their stamps; b's arrive 0.1 ms after their driver.
  for (std::size_t i = 0; i < 3600; ++i) {
    const StampedFrame& frame = streams[0].frames[i];
    streams[0].columns.backend_ms.push_back(to_ms(frame.sensor - frame.arrival) + 10);
    streams[1].columns.backend_ms.push_back(-0.1);
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_THAT(named_kinds(found), Contains("a host_delay"));
  EXPECT_THAT(named_kinds(found), Contains("b link_delay"));
}

// A host's clock is slewed by 500 ppm for 20 s: both cameras' arrivals move alike.
TEST(Evidence, ASlewOfTheHostsClockIsNoFaultOfTheCameras) {
  std::vector<RecordedStream> streams = {record_own_clock("a", 20, 1),
                                         record_own_clock("b", -35, 2)};
  for (RecordedStream& stream : streams) {
    for (StampedFrame& frame : stream.frames) {
      const double since_ms = to_ms(frame.arrival) - kEpochMs;
      frame.arrival += from_ms(std::clamp(since_ms - 40'000, 0.0, 20'000.0) * 500e-6);
    }
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_LT(found.verdict.resolution_ppm, 5);
}

TEST(Evidence, CamerasThatVaryByDesignHaveNoGrid) {
  std::vector<RecordedStream> streams;
  boost::random::mt19937 random(4);
  boost::random::uniform_01<double> uniform;
  for (const char* name : {"a", "b"}) {
    RecordedStream stream = epoch_stream({.name = name, .frames = 1800});
    double at_ms = 0;
    for (StampedFrame& frame : stream.frames) {
      at_ms += 25 + 35 * uniform(random);
      const Nanoseconds delay = frame.arrival - frame.sensor;
      frame.sensor = from_ms(kEpochMs) + from_ms(at_ms);
      frame.arrival = frame.sensor + delay;
    }
    streams.push_back(stream);
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kCannotBeTold);
  EXPECT_THAT(found.verdict.reason, HasSubstr("vary by themselves"));
  EXPECT_THAT(named_kinds(found), ElementsAre("a no_grid", "b no_grid"));
  EXPECT_EQ(diagnosed_camera(found, "a").facts.missing(), 0);
}

// A frame that is held back comes after the next one.
TEST(Evidence, FramesOutOfOrderAreNotLost) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a", .delay_sd_ms = 0.1}),
                                         epoch_stream({.name = "b", .delay_sd_ms = 0.1})};
  for (std::size_t i = 100; i + 1 < 3600; i += 100) {
    streams[1].frames[i].arrival += from_ms(34);
    std::swap(streams[1].frames[i], streams[1].frames[i + 1]);
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(diagnosed_camera(found, "b").facts.out_of_order, 35);
  EXPECT_EQ(diagnosed_camera(found, "b").facts.missing(), 0);
  EXPECT_THAT(named_kinds(found), ElementsAre("b out_of_order"));
}

// Frames that wait for the fourth and come together: neither slips nor swaps.
TEST(Evidence, BatchesAreNamed) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}), epoch_stream({.name = "b"})};
  for (RecordedStream& stream : streams) {
    for (std::size_t i = 0; i < 3600; ++i) {
      const double waits_ms = static_cast<double>(3 - i % 4) * 1000 / 30;
      stream.frames[i].arrival =
          stream.frames[i].sensor + from_ms(30 + waits_ms + 0.1 * static_cast<double>(i % 4));
    }
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_THAT(named_kinds(found), Contains("a batches"));
  EXPECT_THAT(named_kinds(found), Contains("b batches"));
  EXPECT_THAT(named_kinds(found), Not(Contains(HasSubstr("swapped"))));
  EXPECT_THAT(named_kinds(found), Not(Contains(HasSubstr("period_slip"))));
  EXPECT_THAT(found.findings.front().text, HasSubstr("75 % of its frames arrive together"));
}

TEST(Evidence, TheVendorsWordsAreForTheVendorsCameras) {
  std::vector<RecordedStream> streams = {epoch_stream({.name = "a"}), epoch_stream({.name = "b"})};
  EXPECT_THAT(named_kinds(diagnose(streams, {})), IsEmpty());
  streams[0].realsense = true;
  EXPECT_THAT(named_kinds(diagnose(streams, {})), Contains("a global_time"));
}

}  // namespace
}  // namespace simbench::evaluation
