// Sessions as they should go: from a conductor's greeting to the end of the journal.
#include <gmock/gmock.h>

#include "recording/event_text.h"
#include "recording/version.h"
#include "tests/hardware/node/node_harness.h"

namespace simbench::hardware {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

json place(const std::string& session, std::uint64_t offset) {
  return {{"session", session}, {"offset", offset}};
}

CameraFrame depth_frame(std::uint32_t counter) {
  CameraFrame frame;
  frame.counter = counter;
  frame.exposure_us = 8000;
  frame.sensor = {1000 * counter};
  frame.frame = {1000 * counter + 4000};
  frame.arrived = monotonic_now();
  return frame;
}

class NodeSession : public NodeHarness {
 protected:
  static Task<void> expect_ok(TestConductor& conductor, std::string verb,
                              json arguments = json::object()) {
    const NodeAnswer answer = co_await conductor.ask(verb, std::move(arguments));
    EXPECT_EQ(answer.error, "") << verb;
    if (answer.details.contains("problems")) {
      EXPECT_THAT(answer.details["problems"], IsEmpty()) << verb;
    }
  }

  static Task<void> capture(NodeSession& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    co_await expect_ok(conductor, "begin", test.terms());
    co_await expect_ok(conductor, "synchronise", role("master"));
    const json synchronised = co_await conductor.notice("synchronised");
    EXPECT_TRUE(synchronised.at("error").is_null());
    co_await expect_ok(conductor, "prepare");
    co_await expect_ok(conductor, "start");
    for (std::uint32_t counter = 1; counter <= 5; ++counter) {
      for (const char* serial : {"serial0", "serial1", "serial2"}) {
        EXPECT_TRUE(test.cameras_->frame(serial, depth_frame(counter)));
      }
    }
    co_await expect_ok(conductor, "stop");
    EXPECT_FALSE(test.cameras_->runs("serial0"));
    const NodeAnswer read = co_await conductor.ask("read", place(kSession, 0));
    EXPECT_FALSE(read.details.at("closed").get<bool>());
    EXPECT_THAT(test.frames_of(test.journal()), SizeIs(15)) << "all on disk when stop has returned";
    co_await expect_ok(conductor, "end", in_session(kSession));
    const NodeAnswer last = co_await conductor.ask("read", place(kSession, 0));
    EXPECT_TRUE(last.details.at("closed").get<bool>());
    const auto text = last.details.at("text").get<std::string>();
    EXPECT_EQ(last.details.at("size").get<std::size_t>(), text.size());
    std::string whole;
    for (const std::string& line : test.journal()) whole += line + "\n";
    EXPECT_EQ(text, whole);
  }

  static Task<void> greet(NodeSession& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    const NodeAnswer hello = co_await conductor.ask("hello");
    EXPECT_EQ(hello.details.at("version"), version());
    EXPECT_EQ(hello.details.at("commit"), commit());
    EXPECT_EQ(hello.details.at("name"), "host0");
    EXPECT_TRUE(hello.details.at("session").is_null());
    EXPECT_EQ(hello.details.at("clock").at("kind"), "software");
    EXPECT_EQ(hello.details.at("clock").at("skew_ppm"), 25.0);
    EXPECT_EQ(hello.details.at("clock").at("monotonic_zero_ns"),
              nanoseconds_of(test.clock_->oscillator().monotonic_zero));
    EXPECT_THAT(hello.details.at("cameras"), SizeIs(3));
    EXPECT_EQ(hello.details.at("cameras").at(2).at("serial"), "serial2");
    EXPECT_EQ(hello.details.at("cameras").at(2).at("problem"), "");
    co_await expect_ok(conductor, "ping");
    co_await expect_ok(conductor, "begin", test.terms());
    const NodeAnswer during = co_await conductor.ask("hello");
    EXPECT_EQ(during.details.at("session"), kSession);
  }

  static Task<void> stamps(NodeSession& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    co_await expect_ok(conductor, "begin", test.terms());
    co_await expect_ok(conductor, "prepare");
    co_await expect_ok(conductor, "start");
    CameraFrame plain = depth_frame(1);
    CameraFrame with_backend = depth_frame(2);
    with_backend.stream = StreamKind::kColour;
    with_backend.domain = StampDomain::kGlobalTime;
    with_backend.backend = with_backend.arrived - from_ms(0.5);
    // On host 1 of two with three cameras each, the second camera is number 4 of the rig.
    EXPECT_TRUE(test.cameras_->frame("serial4", plain));
    EXPECT_TRUE(test.cameras_->frame("serial4", with_backend));
    co_await expect_ok(conductor, "stop");
    const std::vector<FrameRecord> frames = test.frames_of(test.journal());
    EXPECT_THAT(frames, SizeIs(2));
    if (frames.size() != 2) co_return;
    EXPECT_EQ(frames[0].camera, 4U);
    EXPECT_EQ(frames[0].counter, 1U);
    EXPECT_EQ(frames[0].exposure_us, 8000U);
    EXPECT_EQ(frames[0].sensor.us, 1000U);
    EXPECT_EQ(frames[0].frame.us, 5000U);
    EXPECT_EQ(frames[0].arrival, test.clock_->system_at(plain.arrived));
    EXPECT_EQ(frames[0].arrival_steady, test.clock_->steady_at(plain.arrived));
    EXPECT_EQ(frames[0].backend, frames[0].arrival) << "a source without one";
    EXPECT_EQ(frames[1].stream, StreamKind::kColour);
    EXPECT_EQ(frames[1].domain, StampDomain::kGlobalTime);
    EXPECT_EQ(frames[1].backend, test.clock_->system_at(*with_backend.backend));
    co_await expect_ok(conductor, "end", in_session(kSession));
  }

  static Task<void> endless(NodeSession& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    co_await expect_ok(conductor, "begin", test.terms());
    co_await expect_ok(conductor, "synchronise", role("master"));
    EXPECT_EQ(test.seen_.masters, 1);
    co_await test.pause(from_ms(20));
    EXPECT_EQ(test.seen_.alive, 1);
    const NodeAnswer again = co_await conductor.ask("synchronise", role("master"));
    EXPECT_THAT(again.error, HasSubstr("already started"));
    co_await expect_ok(conductor, "end", in_session(kSession));
    EXPECT_EQ(test.seen_.alive, 0) << "the service goes on until the end, and no longer";
  }

  static Task<void> another(NodeSession& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    co_await expect_ok(conductor, "begin", test.terms());
    co_await expect_ok(conductor, "synchronise", role("master"));
    co_await expect_ok(conductor, "prepare");
    co_await expect_ok(conductor, "start");
    EXPECT_TRUE(test.cameras_->frame("serial0", depth_frame(1)));
    co_await expect_ok(conductor, "begin", test.terms("fedcba9876543210"));
    EXPECT_FALSE(test.cameras_->runs("serial0"));
    EXPECT_EQ(test.seen_.alive, 0);
    EXPECT_THAT(test.frames_of(test.journal()), SizeIs(1));
    EXPECT_THAT(test.logged(), HasSubstr("its conductor begins another"));
    // The new one is whole: its clock is observed and its host_sync starts.
    co_await expect_ok(conductor, "synchronise", role("master"));
    EXPECT_EQ(test.seen_.masters, 2);
    co_await test.pause(from_ms(20));
    EXPECT_EQ(test.seen_.alive, 1);
    co_await expect_ok(conductor, "end", in_session("fedcba9876543210"));
  }

  static Task<void> read_again(NodeSession& test, std::string session) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    const NodeAnswer read = co_await conductor.ask("read", place(session, 0));
    EXPECT_EQ(read.error, "");
    EXPECT_TRUE(read.details.at("closed").get<bool>());
    EXPECT_THAT(read.details.at("text").get<std::string>(), StartsWith("adjustment,"));
    const NodeAnswer none = co_await conductor.ask("read", place("ffffffffffffffff", 0));
    EXPECT_THAT(none.error, HasSubstr("host0 has no journal of it"));
  }
};

TEST_F(NodeSession, ACaptureIsInTheJournal) {
  make_node("3cam_1host_30fps");
  run(capture(*this));
  const std::vector<std::string> lines = journal();
  ASSERT_THAT(lines, SizeIs(testing::Ge(17)));
  EXPECT_THAT(lines[0], StartsWith("adjustment,0,")) << "the clock as it was at the beginning";
  EXPECT_THAT(lines[1], StartsWith("exchange,0,0,5,"));
  const std::vector<FrameRecord> frames = frames_of(lines);
  ASSERT_THAT(frames, SizeIs(15));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].camera, i % 3);
    EXPECT_EQ(frames[i].counter, 1 + i / 3);
  }
  EXPECT_THAT(logged(), HasSubstr("begun by me@here: scenario 3cam_1host_30fps"));
  EXPECT_THAT(logged(), HasSubstr("ended (on request): 15 frames, 0 not kept"));
}

TEST_F(NodeSession, CamerasAreSetAsTheScenarioSays) {
  make_node("3cam_1host_30fps");
  run(capture(*this));
  const CameraSettings settings = cameras_->settings();
  EXPECT_EQ(settings.sync_mode, scenarios::SyncMode::kGenlock);
  EXPECT_EQ(settings.exposure_ms, scenario_.cameras.exposure_ms);
  EXPECT_EQ(settings.trigger_rate_hz, 30);
  EXPECT_FALSE(settings.auto_exposure);
  ASSERT_THAT(settings.streams, SizeIs(1));
  EXPECT_EQ(settings.streams[0].width, 848);
}

TEST_F(NodeSession, AHelloTellsWhoAndWhat) {
  make_node("3cam_1host_30fps");
  run(greet(*this));
}

TEST_F(NodeSession, StampsAreOfTheInstantOfArrival) {
  make_node("6cam_2host_30fps", 1);
  run(stamps(*this));
}

TEST_F(NodeSession, AServiceRunsUntilTheEnd) {
  sync_ = SyncKind::kGoesOn;
  make_node("3cam_1host_30fps");
  run(endless(*this));
}

TEST_F(NodeSession, ItsConductorMayBeginAnother) {
  sync_ = SyncKind::kGoesOn;
  make_node("3cam_1host_30fps");
  run(another(*this));
}

TEST_F(NodeSession, JournalsOutliveTheNode) {
  make_node("3cam_1host_30fps");
  run(capture(*this));
  stop_node();
  make_node("3cam_1host_30fps");
  run(read_again(*this, kSession));
}

}  // namespace
}  // namespace simbench::hardware
