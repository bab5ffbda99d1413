#include "hardware/conductor/rig_source.h"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "recording/event.h"
#include "tests/hardware/conductor/cuttable_link.h"
#include "tests/hardware/conductor/test_rig.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// What a session gave, or why it failed.
struct Outcome {
  KeptRecording recording;
  RecordingCost cost;
  std::string failure;
  std::vector<std::string> progress;

  std::size_t frames(std::uint32_t camera) const {
    std::size_t count = 0;
    for (const KeptEvent& event : recording.events()) {
      const auto* frame = event_as<FrameEvent>(event);
      count += frame != nullptr && frame->record.camera == camera ? 1 : 0;
    }
    return count;
  }
};

// `on_capture` is called, on another thread, once the capture has begun.
Outcome record(const Rig& rig, const scenarios::Scenario& scenario,
               const std::function<void()>& on_capture = {}, const std::string& collect = "",
               std::string* session = nullptr) {
  Outcome outcome;
  std::jthread meanwhile;
  RigSourceSettings settings;
  settings.collect_session = collect;
  settings.progress = [&](const std::string& line) {
    outcome.progress.push_back(line);
    if (on_capture && line.starts_with("capturing")) meanwhile = std::jthread(on_capture);
  };
  RigSource source(rig, SecretKey(), scenario, settings);
  try {
    outcome.cost = source.record({.seed = 1, .pipeline = kTestPipeline}, outcome.recording);
  } catch (const RecordingFailed& error) {
    outcome.failure = error.what();
  }
  if (session != nullptr) *session = source.session();
  return outcome;
}

TEST(RigSource, RecordsAllFramesOfAllHostsInOrder) {
  const TestRig rig({0, 50});
  const Outcome outcome = record(rig.rig(), small_scenario());
  EXPECT_EQ(outcome.failure, "");
  EXPECT_THAT(outcome.cost.notes, IsEmpty());
  EXPECT_EQ(outcome.recording.layout().hosts, 2U);
  EXPECT_EQ(outcome.recording.layout().first_pulse, 3);
  EXPECT_EQ(outcome.recording.layout().pulses, 20);
  for (const std::uint32_t camera : {0U, 1U}) {
    EXPECT_GE(outcome.frames(camera), 23U);
    EXPECT_EQ(outcome.frames(camera), rig.frames_delivered(camera));
  }
  HostTime last = HostTime::min();  // and there are frames, as counted above
  for (const KeptEvent& event : outcome.recording.events()) {
    const auto* frame = event_as<FrameEvent>(event);
    if (frame == nullptr) continue;
    EXPECT_LE(last, frame->record.arrival);
    last = frame->record.arrival;
  }
}

TEST(RigSource, SaysWhichNodeIsNotThere) {
  TestRig rig({0, 0});
  rig.take_away(1);
  const Outcome outcome = record(rig.rig(), small_scenario());
  EXPECT_THAT(outcome.failure,
              AllOf(HasSubstr("greeting the nodes: host1 (127.0.0.1:"), Not(HasSubstr("host0"))));
}

TEST(RigSource, NamesAnIp6AddressOnce) {
  const TestRig nodes({0, 0});
  Rig rig = nodes.rig();
  rig.hosts[1].address = "::1";
  const Outcome outcome = record(rig, small_scenario());
  EXPECT_THAT(outcome.failure,
              HasSubstr("host1 ([::1]:" + std::to_string(rig.hosts[1].port) + "): no connection"));
}

TEST(RigSource, SaysWhichCameraRefuses) {
  TestRig rig({0, 0});
  rig.break_cameras(1);
  const Outcome outcome = record(rig.rig(), small_scenario());
  EXPECT_THAT(outcome.failure,
              AllOf(HasSubstr("host1: camera cam1"), HasSubstr("it offers 640x480")));
}

TEST(RigSource, SaysThatNoFrameCame) {
  TestRig rig({0, 0});
  for (const std::size_t host : {0U, 1U}) rig.silence_cameras(host);
  const Outcome outcome = record(rig.rig(), small_scenario());
  EXPECT_EQ(outcome.failure, "");
  EXPECT_THAT(outcome.cost.notes,
              Contains(HasSubstr("no frame arrived; is the trigger connected")));
}

TEST(RigSource, SaysWhichCameraHasNoFrame) {
  TestRig rig({0, 0});
  rig.silence_cameras(1);
  const Outcome outcome = record(rig.rig(), small_scenario());
  EXPECT_THAT(outcome.cost.notes, ElementsAre(HasSubstr("host1: camera cam1: no frame came")));
}

TEST(RigSource, UnknownPipelinesAreRefusedByTheNodes) {
  const TestRig rig({0, 0});
  const scenarios::Scenario scenario = small_scenario();
  RigSource source(rig.rig(), SecretKey(), scenario, {});
  KeptRecording kept;
  EXPECT_THROW(source.record({.seed = 1, .pipeline = "unheard_of"}, kept), RecordingFailed);
}

TEST(RigSource, SaysWhichCamerasCannotBeSteered) {
  const TestRig rig({0, 0});
  const scenarios::Scenario scenario = small_scenario(
      {{"/cameras/frame_control",
        R"({"adjust_frame": true, "insert_frame": true, "frame_length": true, "start_at": true,
            "granularity_us": 10, "shortest_ms": 12, "longest_ms": 60, "latency_frames": 2,
            "delay_ms": 0, "delay_exponential_ms": 0, "loss_probability": 0, "insert_stretches": 1,
            "insert_noise_sigma_us": 0, "start_jitter_sigma_us": 0, "frame_jitter_sigma_us": 0,
            "sensor_clock": "camera"})"}});
  RigSource source(rig.rig(), SecretKey(), scenario, {});
  KeptRecording kept;
  EXPECT_THAT([&] { source.record({.seed = 1, .pipeline = kAlignedPipeline}, kept); },
              testing::ThrowsMessage<RecordingFailed>(
                  AllOf(HasSubstr("setting the cameras: host0: camera cam0: its frames cannot"),
                        HasSubstr("host1: camera cam1"), HasSubstr("RealSense's SDK"))));
}

class IdealAlignment final : public CaptureAlignment {
 public:
  Steering steering() const override { return Steering::kIdeal; }
  Task<void> run_master(Host&, std::vector<PeerId>) override { co_return; }
  Task<void> run_slave(Host&, PeerId) override { co_return; }
};

TEST(RigSource, AnOraclesExposuresAreRefused) {
  const TestRig rig({0, 0});
  const scenarios::Scenario scenario = small_scenario();
  RigSource source(rig.rig(), SecretKey(), scenario, {});
  KeptRecording kept;
  IdealAlignment ideal;
  const RecordingRequest request{.seed = 1, .pipeline = kTestPipeline, .capture_alignment = &ideal};
  EXPECT_THAT([&] { source.record(request, kept); },
              testing::ThrowsMessage<RecordingFailed>(HasSubstr("exposures exist only in the")));
}

TEST(RigSource, ARigOfOtherSizeIsRefusedAtOnce) {
  const TestRig rig({0});
  EXPECT_THROW(RigSource(rig.rig(), SecretKey(), small_scenario(), {}), scenarios::InputError);
}

TEST(RigSource, ANodeThatIsRestartedDuringTheCaptureLosesNothingItHadRecorded) {
  TestRig rig({0, 0});
  const scenarios::Scenario scenario = small_scenario({{"/timeline/frames", "60"}});
  std::size_t recorded = 0;
  const Outcome outcome = record(rig.rig(), scenario, [&] {
    while (rig.frames_delivered(1) < 20) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    recorded = rig.restart(1);
  });
  EXPECT_EQ(outcome.failure, "");
  EXPECT_GT(recorded, 0U);
  EXPECT_GE(outcome.frames(1), recorded) << testing::PrintToString(outcome.cost.notes);
  EXPECT_GE(outcome.frames(0), 63U);
  EXPECT_THAT(outcome.cost.notes, Contains(HasSubstr("host1")));
}

TEST(RigSource, ACutLinkThatIsMendedCostsNothing) {
  const TestRig rig({0, 0});
  CuttableLink link(rig.rig().hosts[1].port);
  Rig through_link = rig.rig();
  through_link.hosts[1].port = link.port();
  const scenarios::Scenario scenario = small_scenario({{"/timeline/frames", "60"}});
  const Outcome outcome = record(through_link, scenario, [&] {
    while (rig.frames_delivered(1) < 10) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    link.cut();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    link.mend();
  });
  EXPECT_EQ(outcome.failure, "");
  EXPECT_THAT(outcome.cost.notes, IsEmpty());
  EXPECT_EQ(outcome.frames(1), rig.frames_delivered(1));
}

TEST(RigSource, AHostWhoseLinkStaysCutIsGivenUpAndTheOthersGoOn) {
  const TestRig rig({0, 0});
  CuttableLink link(rig.rig().hosts[1].port);
  Rig through_link = rig.rig();
  through_link.hosts[1].port = link.port();
  const Outcome outcome = record(through_link, small_scenario(), [&] {
    while (rig.frames_delivered(1) < 10) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    link.cut();
  });
  EXPECT_EQ(outcome.failure, "");
  EXPECT_GE(outcome.frames(0), 23U);
  EXPECT_THAT(outcome.cost.notes, Contains(HasSubstr("host1 was lost")));
}

TEST(RigSource, TwoConductorsAreNotLetIn) {
  const TestRig rig({0, 0});
  const scenarios::Scenario scenario = small_scenario({{"/timeline/frames", "40"}});
  Outcome second;
  const Outcome first = record(rig.rig(), scenario, [&] { second = record(rig.rig(), scenario); });
  EXPECT_EQ(first.failure, "");
  EXPECT_GE(first.frames(0), 43U);
  EXPECT_THAT(second.failure, AllOf(HasSubstr("host0"), HasSubstr("busy")));
}

// Commands for the trigger that leave their names in `file`.
RigTrigger logged_trigger(const std::string& file, const std::string& after_off = "") {
  return {.manual = false,
          .on_command = "echo on >> " + file,
          .off_command = "echo off >> " + file + after_off};
}

std::string words_in(const std::string& file) {
  std::ifstream in(file);
  std::string words;
  for (std::string word; in >> word;) words += (words.empty() ? "" : " ") + word;
  return words;
}

// Records until the capture has frames, then cancels; the lines of progress.
std::vector<std::string> interrupted(const TestRig& nodes, const Rig& rig,
                                     std::function<bool(const std::string&)> prompt = {}) {
  const scenarios::Scenario scenario = small_scenario({{"/timeline/frames", "400"}});
  std::vector<std::string> progress;
  RigSourceSettings settings;
  settings.progress = [&](const std::string& line) { progress.push_back(line); };
  settings.prompt = std::move(prompt);
  settings.cancelled = [&] { return nodes.frames_delivered(0) > 5; };
  RigSource source(rig, SecretKey(), scenario, settings);
  KeptRecording kept;
  EXPECT_THROW(source.record({.seed = 1, .pipeline = kTestPipeline}, kept), std::runtime_error);
  return progress;
}

TEST(RigSource, AnInterruptSwitchesTheTriggerOff) {
  const ScratchFolder folder;
  const TestRig nodes({0, 0});
  Rig rig = nodes.rig();
  rig.trigger = logged_trigger(folder / "trigger");
  const std::vector<std::string> progress = interrupted(nodes, rig);
  EXPECT_THAT(progress, Not(Contains(HasSubstr("trigger off"))));
  EXPECT_EQ(words_in(folder / "trigger"), "off on off");
}

TEST(RigSource, AnInterruptDoesNotPromptAgain) {
  const TestRig nodes({0, 0});
  Rig rig = nodes.rig();
  rig.trigger = RigTrigger{.manual = true, .on_command = {}, .off_command = {}};
  std::vector<std::string> prompts;
  const std::vector<std::string> progress = interrupted(nodes, rig, [&](const std::string& text) {
    prompts.push_back(text);
    return true;
  });
  EXPECT_THAT(prompts, ElementsAre("Switch the trigger off now", "Switch the trigger on now"));
  EXPECT_THAT(progress, Contains(HasSubstr("the trigger is still on: switch it off")));
}

TEST(RigSource, ATriggerThatStaysOnAfterAnInterruptIsANote) {
  const ScratchFolder folder;
  const TestRig nodes({0, 0});
  Rig rig = nodes.rig();
  const std::string file = folder / "trigger";
  rig.trigger = logged_trigger(file, "; test $(grep -c off " + file + ") -lt 2");
  const std::vector<std::string> progress = interrupted(nodes, rig);
  EXPECT_THAT(progress, Contains(HasSubstr("trigger off: ")));
  EXPECT_EQ(words_in(file), "off on off");
}

TEST(RigSource, CollectsTheJournalsOfAnEarlierSession) {
  const TestRig rig({0, 0});
  std::string session;
  const Outcome first = record(rig.rig(), small_scenario(), {}, "", &session);
  const Outcome again = record(rig.rig(), small_scenario(), {}, session);
  EXPECT_EQ(again.failure, "");
  EXPECT_EQ(again.frames(0), first.frames(0));
  EXPECT_EQ(again.frames(1), first.frames(1));
  const Outcome never = record(rig.rig(), small_scenario(), {}, "0123456789abcdef");
  EXPECT_THAT(never.failure, HasSubstr("no node has a journal of it"));
}

}  // namespace
}  // namespace simbench::hardware
