// Sessions whose pipeline has a capture_alignment.
#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <utility>

#include "tests/hardware/node/made_up_steering.h"
#include "tests/hardware/node/node_harness.h"

namespace simbench::hardware {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

constexpr const char* kSteered = "18cam_6host_30fps_without_trigger";

class NodeAlignment : public NodeHarness {
 protected:
  NodeAlignment() { aligns_ = true; }

  static Task<void> start(TestConductor& conductor, json terms) {
    co_await conductor.connect();
    const NodeAnswer begun = co_await conductor.ask("begin", std::move(terms));
    EXPECT_EQ(begun.error, "");
    const NodeAnswer prepared = co_await conductor.ask("prepare");
    EXPECT_EQ(prepared.error, "");
    const NodeAnswer started = co_await conductor.ask("start");
    EXPECT_EQ(started.error, "");
  }

  static Task<void> capture(NodeAlignment& test) {
    TestConductor conductor = test.conductor();
    co_await start(conductor, test.terms());
    co_await test.pause(from_ms(20));
    EXPECT_EQ(test.aligned_.alive, 1);
    co_await conductor.ask("stop");
    EXPECT_EQ(test.aligned_.alive, 0) << "it runs until the cameras stop";
    co_await conductor.ask("end", in_session(kSession));
  }

  static Task<void> unsteered(NodeAlignment& test) {
    TestConductor conductor = test.conductor();
    co_await start(conductor, test.terms());
    co_await conductor.ask("end", in_session(kSession));
  }

  static Task<void> unsteerable(NodeAlignment& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    co_await conductor.ask("begin", test.terms());
    const NodeAnswer prepared = co_await conductor.ask("prepare");
    EXPECT_THAT(prepared.details.at("problems"), SizeIs(3));
    const auto text = prepared.details.at("problems").at(0).at("text").get<std::string>();
    EXPECT_THAT(text, HasSubstr("cannot be steered"));
    EXPECT_THAT(text, HasSubstr("RealSense"));
    co_await conductor.ask("end", in_session(kSession));
  }

  static Task<void> ends_while_it_runs(NodeAlignment& test) {
    TestConductor conductor = test.conductor();
    co_await start(conductor, test.terms());
    co_await test.pause(from_ms(20));
    co_await conductor.ask("end", in_session(kSession));
    EXPECT_EQ(test.aligned_.alive, 0);
  }

  static Task<void> failure(NodeAlignment& test) {
    TestConductor conductor = test.conductor();
    co_await start(conductor, test.terms());
    const json note = co_await conductor.notice("note");
    EXPECT_THAT(note.at("text").get<std::string>(), HasSubstr("capture_alignment failed: no grid"));
    co_await conductor.ask("end", in_session(kSession));
  }
};

TEST_F(NodeAlignment, RunsWhileTheCamerasDoAndIsOnRecord) {
  make_node(kSteered, 1);
  const auto steering = std::make_shared<MadeUpSteering>(
      FrameSteering{.limits = {.frame_length = from_ms(33),
                               .shortest = from_ms(17),
                               .longest = from_ms(66),
                               .granularity = from_us(10),
                               .allowed = {true, true, true, true}}});
  cameras_->steering = steering;
  run(capture(*this));
  EXPECT_EQ(aligned_.slaves, 1);
  EXPECT_EQ(aligned_.masters, 0);
  EXPECT_THAT(steering->controls, SizeIs(3));
  EXPECT_THAT(journal(), Contains(StartsWith("alignment,4,true,1,")));
  EXPECT_THAT(journal(), Not(Contains(StartsWith("note,"))));
}

TEST_F(NodeAlignment, CamerasAreSetAsTheScenarioSays) {
  make_node(kSteered);
  cameras_->steering = std::make_shared<MadeUpSteering>();
  run(capture(*this));
  EXPECT_EQ(aligned_.masters, 1);
  const CameraSettings settings = cameras_->settings();
  ASSERT_TRUE(settings.steering.has_value());
  const FrameControlLimits& limits = settings.steering->limits;
  EXPECT_EQ(limits.frame_length, from_ms(1e3 / 30));
  EXPECT_EQ(limits.shortest, from_ms(17));
  EXPECT_EQ(limits.longest, from_ms(70));
  EXPECT_EQ(limits.granularity, from_us(10));
  EXPECT_EQ(limits.latency_frames, 2U);
  EXPECT_EQ(limits.exposure, from_ms(scenario_.cameras.exposure_ms));
  EXPECT_TRUE(limits.allows(FrameControlKind::kStartAt));
}

TEST_F(NodeAlignment, WithoutOneCamerasAreNotSteered) {
  aligns_ = false;
  make_node(kSteered);
  run(unsteered(*this));
  EXPECT_FALSE(cameras_->settings().steering.has_value());
}

TEST_F(NodeAlignment, ACameraThatCannotBeSteeredIsAProblem) {
  make_node(kSteered);
  run(unsteerable(*this));
  EXPECT_EQ(aligned_.masters, 0);
}

TEST_F(NodeAlignment, EndsWithTheSession) {
  make_node(kSteered);
  cameras_->steering = std::make_shared<MadeUpSteering>();
  run(ends_while_it_runs(*this));
}

TEST_F(NodeAlignment, ItsFailureIsANote) {
  make_node(kSteered);
  cameras_->steering = std::make_shared<MadeUpSteering>();
  alignment_ = SyncKind::kThrows;
  run(failure(*this));
}

}  // namespace
}  // namespace simbench::hardware
