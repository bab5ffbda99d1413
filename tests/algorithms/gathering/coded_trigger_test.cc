#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"
#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {
namespace {

// The frames of cameras that start and deliver as they like, in order of arrival. No stamp but the
// sensor's tells anything.
std::vector<GatherFrame> rig_frames(const CodedPulses& pulses,
                                    const std::vector<CodedCamera>& cameras, std::int64_t last,
                                    std::uint32_t seed) {
  std::vector<GatherFrame> frames;
  for (std::uint32_t source = 0; source < cameras.size(); ++source) {
    const CodedCamera& camera = cameras[source];
    for (const CodedFrame& frame :
         coded_frames(pulses, camera, last - camera.first, seed + source)) {
      frames.push_back({.source = source,
                        .exposure_us = frame.exposure_us,
                        .stamp = GlobalTime(Nanoseconds(source * 5'000'000'007)),
                        .arrival = GlobalTime(frame.pulse * pulses.code.period() +
                                              Microseconds(8000 + 300 * source)),
                        .sensor = frame.sensor,
                        .tag = frame.pulse});
    }
  }
  std::ranges::stable_sort(frames, {}, &GatherFrame::arrival);
  return frames;
}

CollectedSets sets_of_rig(Gatherer& gatherer, const std::vector<GatherFrame>& frames) {
  CollectedSets out;
  for (const GatherFrame& frame : frames) gatherer.push(frame, out);
  return out;
}

// Pulses of which every camera delivered its frame, from the first that all can have on.
std::int64_t delivered_by_all(const std::vector<GatherFrame>& frames, std::size_t cameras,
                              std::int64_t from) {
  std::vector<std::size_t> count;
  for (const GatherFrame& frame : frames) {
    if (frame.tag < from) continue;
    const auto place = static_cast<std::size_t>(frame.tag - from);
    if (place >= count.size()) count.resize(place + 1);
    ++count[place];
  }
  return std::ranges::count(count, cameras);
}

std::unique_ptr<Gatherer> coded_gatherer(const std::shared_ptr<const CodedPulses>& pulses,
                                         std::uint32_t sources) {
  return make_coded_trigger_gatherer({.sources = sources, .pulses = pulses}, {});
}

TEST(CodedTriggerGatherer, FindsEverySetThroughLossesAndStartsOneByOne) {
  const auto pulses = usual_pulses();
  std::vector<CodedCamera> cameras;
  for (std::uint32_t i = 0; i < 18; ++i) {
    cameras.push_back({.first = (i * 7) % 45,
                       .rate_ppm = 10.0 * i - 90,
                       .offset_us = 3e8 * i,
                       .noise_us = 2,
                       .loss = 0.005});
  }
  const auto frames = rig_frames(*pulses, cameras, 1000, 7);
  const auto gatherer = coded_gatherer(pulses, 18);
  const CollectedSets out = sets_of_rig(*gatherer, frames);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
  EXPECT_EQ(out.pure(), delivered_by_all(frames, 18, 0)) << "also those before the last search";
  const PlaceSearch search = *gatherer->place_search();
  EXPECT_EQ(search.sources, 18U);
  EXPECT_EQ(search.found, 18U);
  EXPECT_EQ(search.again, 0U);
  EXPECT_LE(search.frames, 30U);
  EXPECT_NEAR(search.seconds, search.frames / 90.0, 0.05);
  EXPECT_LE(search.error_probability, 1e-9);
}

TEST(CodedTriggerGatherer, ACameraThatStartsCyclesLaterJoinsTheOthers) {
  const auto pulses = pulses_of(TriggerCode::position(from_ns(1e9 / 90), 7, from_us(50)));
  const std::vector<CodedCamera> cameras = {{}, {.first = 128 * 5 + 77, .offset_us = 4e8}};
  const auto frames = rig_frames(*pulses, cameras, 1500, 1);
  const auto gatherer = coded_gatherer(pulses, 2);
  const CollectedSets out = sets_of_rig(*gatherer, frames);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
  EXPECT_EQ(out.pure(), 1500 - (128 * 5 + 77));
}

TEST(CodedTriggerGatherer, ARebootOfACameraIsNoWrongSet) {
  const auto pulses = usual_pulses();
  auto frames = rig_frames(*pulses, {{.offset_us = 9e9}, {}}, 900, 1);
  for (GatherFrame& frame : frames) {
    if (frame.source == 0 && frame.tag >= 400) frame.sensor -= Microseconds(8'000'000'123);
  }
  const auto gatherer = coded_gatherer(pulses, 2);
  const CollectedSets out = sets_of_rig(*gatherer, frames);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
  EXPECT_EQ(out.pure(), 900);
  EXPECT_EQ(gatherer->place_search()->again, 1U);
}

TEST(CodedTriggerGatherer, WithoutItsCodeThereIsNoSet) {
  const auto pulses = usual_pulses();
  const auto even = pulses_of(TriggerCode::position(from_ns(1e9 / 90), 12, Nanoseconds(1)));
  const auto frames = rig_frames(*even, {{}, {}}, 2000, 1);
  const auto gatherer = coded_gatherer(pulses, 2);
  EXPECT_TRUE(sets_of_rig(*gatherer, frames).sets.empty());
  EXPECT_EQ(gatherer->place_search()->found, 0U);
}

TEST(CodedTriggerGatherer, ItsQueueIsBounded) {
  const auto pulses = usual_pulses();
  const auto frames = rig_frames(*pulses, {{}, {.first = 2000}}, 2001, 1);
  const auto gatherer =
      make_coded_trigger_gatherer({.sources = 2, .queue_limit = 40, .pulses = pulses}, {});
  sets_of_rig(*gatherer, frames);
  EXPECT_GE(gatherer->discarded(), 2000U - 40);
}

}  // namespace
}  // namespace simbench
