// Diagnoses of simulated captures, recorded as a user would.
#include <gmock/gmock.h>

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/evaluation/recorded_streams.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::SizeIs;

using Overrides = std::vector<scenarios::Override>;

scenarios::Scenario three_cameras(Overrides overrides = {}, std::int64_t frames = 1800) {
  overrides.push_back({"/timeline/frames", std::to_string(frames)});
  return scenarios::load_scenario("3cam_1host_30fps", overrides);
}

std::vector<RecordedStream> recorded(const scenarios::Scenario& scenario, std::uint64_t seed) {
  RecordedStreams recording;
  sim::make_simulation(scenario)->record(
      {.seed = seed, .pipeline = scenario.pipelines.front().name}, recording);
  return recording.streams;
}

Diagnosis diagnosed(const scenarios::Scenario& scenario, std::uint64_t seed = 1,
                    const DiagnoseOptions& options = {}) {
  return diagnose(recorded(scenario, seed), options);
}

std::vector<std::string> kinds_found(const Diagnosis& diagnosis) {
  std::vector<std::string> all;
  for (const Finding& finding : diagnosis.findings) all.push_back(finding.kind);
  return all;
}

TEST(DiagnoseSimulated, GenlockWorks) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Diagnosis found = diagnosed(three_cameras(), seed);
    EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << "seed " << seed << found.verdict.reason;
    EXPECT_THAT(found.findings, IsEmpty()) << "seed " << seed;
  }
}

TEST(DiagnoseSimulated, DefaultModeRunsFree) {
  const scenarios::Scenario scenario =
      three_cameras({{"/cameras/sync_mode", "\"default\""}, {"/trigger/rate_hz", "60"}}, 3600);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Diagnosis found = diagnosed(scenario, seed);
    EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork) << "seed " << seed;
    EXPECT_THAT(kinds_found(found), Contains("free_running")) << "seed " << seed;
  }
}

TEST(DiagnoseSimulated, TooLongAnExposureHalvesTheRate) {
  const scenarios::Scenario scenario = three_cameras({{"/cameras/exposure_ms", "34"}});
  const Diagnosis found = diagnosed(scenario, 1, {.rate_hz = 30});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_THAT(kinds_found(found), SizeIs(3));
  EXPECT_THAT(kinds_found(found), Each("divided_rate"));
}

TEST(DiagnoseSimulated, FramesThatTheCamerasLoseAreCounted) {
  const Diagnosis found = diagnosed(three_cameras({{"/cameras/drop_probability", "0.02"}}));
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  for (const CameraDiagnosis& camera : nonempty(found.cameras)) {
    EXPECT_NEAR(static_cast<double>(camera.facts.account.lost), 0.02 * 1800, 25);
    EXPECT_EQ(camera.facts.account.never_exposed, 0);
  }
}

TEST(DiagnoseSimulated, ACameraThatVanishesEndsEarly) {
  scenarios::Scenario scenario = three_cameras();
  scenario.faults = {scenarios::CameraVanishes{.camera = 1, .at_ms = 50'000, .duration_ms = 1e6}};
  const Diagnosis found = diagnosed(scenario);
  EXPECT_THAT(found.findings, Contains(Field(&Finding::kind, "ended_early")));
  for (const Finding& finding : found.findings) EXPECT_EQ(finding.camera, "1") << finding.text;
}

TEST(DiagnoseSimulated, AWrapChangesNothing) {
  std::vector<RecordedStream> streams = recorded(three_cameras(), 1);
  const Diagnosis before = diagnose(streams, {});
  constexpr Nanoseconds kRegister = Microseconds(std::int64_t{1} << 32);
  for (RecordedStream& stream : streams) {
    const Nanoseconds first = stream.frames.front().sensor;
    for (StampedFrame& frame : stream.frames) {
      frame.sensor = (frame.sensor - first + kRegister - std::chrono::seconds(30)) % kRegister;
    }
  }
  const Diagnosis after = diagnose(streams, {});
  EXPECT_EQ(after.verdict.reason, before.verdict.reason);
  EXPECT_THAT(kinds_found(after), SizeIs(3));
  EXPECT_THAT(kinds_found(after), Each("register_wraps"));
}

}  // namespace
}  // namespace simbench::evaluation
