// What holds for every algorithm of the stage.
#include <gmock/gmock.h>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/registry.h"
#include "tests/algorithms/capture_alignment/fake_camera.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

TEST(EveryAlignment, SaysWhatItIsAndWhereItsNumbersAreFrom) {
  for (const CaptureAlignmentEntry& each : nonempty(algorithms<CaptureAlignmentEntry>())) {
    EXPECT_FALSE(each.info.summary.empty()) << each.info.name;
    EXPECT_FALSE(each.info.source.empty()) << each.info.name;
    EXPECT_THAT(each.info.needs, testing::Contains(Need::kFrameControl)) << each.info.name;
    for (const ParameterSpec& spec : each.info.parameters) {
      EXPECT_FALSE(spec.meaning.empty()) << each.info.name << "/" << spec.name;
      EXPECT_FALSE(spec.source.empty()) << each.info.name << "/" << spec.name;
    }
    EXPECT_NE(each.make(check_parameters(each.info.parameters, {})), nullptr) << each.info.name;
  }
}

TEST(EveryAlignment, EndsOrWaitsWhereHostsHaveNoCameras) {
  for (const CaptureAlignmentEntry& each : nonempty(algorithms<CaptureAlignmentEntry>())) {
    FakeRig rig(2);
    rig.run(*make_alignment(each.info.name), from_ms(10'000));
    EXPECT_TRUE(rig.host(0).reports().empty() && rig.host(1).reports().empty()) << each.info.name;
  }
}

// Whatever a camera lacks, it is said once, and does not end the run.
TEST(EveryAlignment, TakesCamerasWithoutAnyControl) {
  for (const CaptureAlignmentEntry& each : nonempty(algorithms<CaptureAlignmentEntry>())) {
    if (each.info.family == "limits") continue;
    FakeRig rig(2);
    rig.add(0, {.phase = from_ms(3)});
    FakeCameraScript unable{.phase = from_ms(7)};
    unable.limits.allowed = {};
    const FakeCamera& camera = rig.add(1, unable);
    rig.run(*make_alignment(each.info.name), from_ms(10'000));
    EXPECT_TRUE(camera.controls().empty()) << each.info.name;
    EXPECT_FALSE(rig.host(1).last_report(1).aligned) << each.info.name;
    EXPECT_THAT(rig.host(1).last_report(1).message, testing::HasSubstr("has no control"))
        << each.info.name;
    EXPECT_LE(rig.host(1).reports().size(), 2u) << each.info.name;
  }
}

// They wait, and come to no harm.
TEST(EveryAlignment, TakesCamerasThatFallSilent) {
  for (const CaptureAlignmentEntry& each : nonempty(algorithms<CaptureAlignmentEntry>())) {
    FakeRig rig(2);
    rig.add(0, {.phase = from_ms(3), .stops_at = from_ms(100)});
    rig.add(1, {.phase = from_ms(7), .stops_at = from_ms(50)});
    rig.run(*make_alignment(each.info.name), from_ms(30'000));
    EXPECT_LE(rig.host(0).reports().size(), 3u) << each.info.name;
  }
}

}  // namespace
}  // namespace simbench
