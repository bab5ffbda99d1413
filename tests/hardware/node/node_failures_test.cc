// What goes wrong around a node: conductors that vanish, that are two, that speak nonsense; cameras
// that refuse; algorithms that throw.
#include <gmock/gmock.h>

#include <optional>

#include "hardware/node/journal.h"
#include "recording/version.h"
#include "tests/hardware/node/node_harness.h"

namespace simbench::hardware {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

CameraFrame arrived_now() {
  CameraFrame frame;
  frame.arrived = monotonic_now();
  return frame;
}

json with(json terms, const std::string& name, json value) {
  terms[name] = std::move(value);
  return terms;
}

json master_of(const std::string& slaves) {
  return with(role("master"), "slaves", json::parse(slaves));
}

class NodeFailures : public NodeHarness {
 protected:
  static Task<void> begun(NodeFailures& test, TestConductor& conductor) {
    co_await conductor.connect();
    const NodeAnswer answer = co_await conductor.ask("begin", test.terms());
    EXPECT_EQ(answer.error, "");
  }

  static Task<void> two_conductors(NodeFailures& test) {
    TestConductor first = test.conductor();
    co_await begun(test, first);
    TestConductor second = test.conductor();
    co_await second.connect();
    const NodeAnswer refused = co_await second.ask("begin", test.terms("fedcba9876543210"));
    EXPECT_THAT(refused.error, testing::MatchesRegex("busy: conducted by me@here since "
                                                     "[0-9:]{8} \\(session 0123456789abcdef\\)"));
    for (const char* verb : {"prepare", "start", "stop"}) {
      const NodeAnswer answer = co_await second.ask(verb);
      EXPECT_THAT(answer.error, HasSubstr("no session over this connection")) << verb;
    }
    const NodeAnswer other = co_await second.ask("end", in_session("fedcba9876543210"));
    EXPECT_THAT(other.error, HasSubstr("there is none of that id here"));
    const NodeAnswer still = co_await first.ask("prepare");
    EXPECT_EQ(still.error, "") << "the first one's session goes on";
    const NodeAnswer end = co_await first.ask("end", in_session(kSession));
    EXPECT_EQ(end.error, "");
    const NodeAnswer now = co_await second.ask("begin", test.terms("fedcba9876543210"));
    EXPECT_EQ(now.error, "");
  }

  static Task<void> vanish(NodeFailures& test) {
    std::optional<TestConductor> conductor = test.conductor();
    co_await begun(test, *conductor);
    co_await conductor->ask("synchronise", role("master"));
    co_await conductor->ask("prepare");
    co_await conductor->ask("start");
    EXPECT_TRUE(test.cameras_->frame("serial0", arrived_now()));
    conductor.reset();
    co_await test.pause(test.silence_ / 2);
    EXPECT_TRUE(test.cameras_->runs("serial0")) << "it may come back";
    co_await test.pause(test.silence_ * 2);
    EXPECT_FALSE(test.cameras_->runs("serial0"));
    EXPECT_EQ(test.seen_.alive, 0);
    EXPECT_THAT(test.frames_of(test.journal()), SizeIs(1));
    EXPECT_THAT(test.logged(), HasSubstr("no request from its conductor for 0.4 s"));
    TestConductor next = test.conductor();
    co_await next.connect();
    const NodeAnswer begin = co_await next.ask("begin", test.terms("fedcba9876543210"));
    EXPECT_EQ(begin.error, "");
    const NodeAnswer late = co_await next.ask("end", in_session(kSession));
    EXPECT_EQ(late.error, "") << "the session has ended";
  }

  static Task<void> come_back(NodeFailures& test) {
    std::optional<TestConductor> conductor = test.conductor();
    co_await begun(test, *conductor);
    co_await conductor->ask("prepare");
    conductor.reset();
    co_await test.pause(test.silence_ / 4);
    TestConductor again = test.conductor();
    co_await again.connect();
    const NodeAnswer lost = co_await again.ask("start");
    EXPECT_THAT(lost.error, HasSubstr("name the running one"));
    const NodeAnswer named = co_await again.ask("ping", in_session(kSession));
    EXPECT_EQ(named.error, "");
    const NodeAnswer start = co_await again.ask("start");
    EXPECT_EQ(start.error, "");
    for (int i = 0; i < 8; ++i) {
      co_await test.pause(test.silence_ / 4);
      co_await again.ask("ping");
    }
    EXPECT_TRUE(test.cameras_->runs("serial0")) << "heard of all the time";
    test.cameras_->event("serial1", {CameraEvent::Kind::kDisconnected, "unplugged"});
    const json note = co_await again.notice("note");
    EXPECT_EQ(note.at("text"), "host0: camera serial1: unplugged");
    co_await again.ask("end", in_session(kSession));
    EXPECT_THAT(test.journal(), Contains("note,camera serial1: unplugged"));
  }

  static Task<void> refusing_camera(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    const NodeAnswer prepared = co_await conductor.ask("prepare");
    EXPECT_THAT(prepared.details.at("problems"), SizeIs(1));
    EXPECT_EQ(prepared.details.at("problems").at(0).at("camera"), "serial1");
    EXPECT_EQ(prepared.details.at("problems").at(0).at("text"), "no profile of 848x480 at 90 Hz");
    const json note = co_await conductor.notice("note");
    EXPECT_EQ(note.at("text"), "host0: camera serial1: no profile of 848x480 at 90 Hz");
    const NodeAnswer started = co_await conductor.ask("start");
    EXPECT_THAT(started.details.at("problems"), IsEmpty());
    EXPECT_TRUE(test.cameras_->runs("serial0"));
    EXPECT_FALSE(test.cameras_->runs("serial1"));
    EXPECT_TRUE(test.cameras_->runs("serial2"));
  }

  static Task<void> throwing_sync(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    co_await conductor.ask("synchronise", role("master"));
    const json notice = co_await conductor.notice("synchronised");
    EXPECT_EQ(notice.at("error"), "no way to the master");
    const NodeAnswer ping = co_await conductor.ask("ping");
    EXPECT_EQ(ping.error, "");
  }

  static Task<void> itself_as_a_peer(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    NodeAnswer answer = co_await conductor.ask("synchronise", role("slave"));
    EXPECT_THAT(answer.error, HasSubstr("allowed on the rig's first host: master"));
    answer = co_await conductor.ask("synchronise", master_of("[1, 0]"));
    EXPECT_THAT(answer.error, HasSubstr("slaves: found 0, allowed: other hosts"));
    EXPECT_EQ(test.seen_.masters + test.seen_.slaves, 0);
    answer = co_await conductor.ask("synchronise", master_of("[1]"));
    EXPECT_EQ(answer.error, "") << "none of it did harm";
  }

  static Task<void> clinging_sync(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    co_await conductor.ask("synchronise", role("master"));
    const std::string second = "fedcba9876543210";
    const NodeAnswer answer = co_await conductor.ask("begin", test.terms(second));
    EXPECT_EQ(answer.error, "");
    EXPECT_THAT(test.logged(), HasSubstr("does not end"));
    EXPECT_EQ(test.seen_.alive, 1);
    test.seen_.let_go = true;
    while (test.seen_.alive > 0) co_await test.pause(from_ms(5));
    co_await test.pause(from_ms(5));
    co_await test.clock_->adjust_frequency(5000);
    co_await conductor.ask("end", in_session(second));
    const std::vector<std::string> lines = test.journal(second);
    EXPECT_THAT(lines, SizeIs(2)) << "the clock at the beginning, and its adjustment";
  }

  static Task<void> bad_terms(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await conductor.connect();
    const auto refusal = [&](json terms) { return conductor.ask("begin", std::move(terms)); };
    NodeAnswer answer = co_await refusal(with(test.terms(), "pipeline", "unheard_of"));
    EXPECT_THAT(answer.error,
                AllOf(HasSubstr("no such pipeline"), HasSubstr(version()), HasSubstr(commit())));
    answer = co_await refusal(with(test.terms(), "session", "../../../etc/passwd"));
    EXPECT_THAT(answer.error, HasSubstr("16 hexadecimal digits"));
    answer = co_await refusal(with(test.terms(), "scenario", 7));
    EXPECT_THAT(answer.error, HasSubstr("'scenario': found number, allowed: a text"));
    answer = co_await refusal(with(test.terms(), "scenario", "{\"base\": \"/etc/passwd\"}"));
    EXPECT_THAT(answer.error, HasSubstr("allowed: a resolved scenario"));
    answer = co_await refusal(with(test.terms(), "scenario", "{"));
    EXPECT_THAT(answer.error, HasSubstr("scenario:1"));
    const scenarios::Scenario other = scenarios::load_scenario("18cam_6host_45fps");
    answer = co_await refusal(with(test.terms(), "scenario", other.resolved_json()));
    EXPECT_THAT(answer.error, HasSubstr("found 1 host, allowed 6"));
    EXPECT_THAT(test.journal(), IsEmpty());
    answer = co_await refusal(test.terms());
    EXPECT_EQ(answer.error, "") << "none of it did harm";
    answer = co_await conductor.ask("synchronise", role("oracle"));
    EXPECT_THAT(answer.error, HasSubstr("allowed: master, slave"));
    answer = co_await conductor.ask("start");
    EXPECT_THAT(answer.error, HasSubstr("not prepared"));
    answer = co_await conductor.ask("dance");
    EXPECT_THAT(answer.error, HasSubstr("found 'dance', allowed: hello, begin"));
  }

  static Task<void> nonsense(NodeFailures& test) {
    TestConductor good = test.conductor();
    co_await begun(test, good);
    for (const std::string& text : {std::string("nonsense"), std::string(2u << 20, ' ')}) {
      TestConductor bad = test.conductor();
      co_await bad.connect();
      co_await bad.send_bytes(bytes(text));
      const bool closed = co_await bad.is_closed();
      EXPECT_TRUE(closed);
    }
    const NodeAnswer ping = co_await good.ask("prepare");
    EXPECT_EQ(ping.error, "");
  }

  static Task<void> capture_until_stopped(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    co_await conductor.ask("synchronise", role("master"));
    co_await conductor.ask("prepare");
    co_await conductor.ask("start");
    test.cameras_->frame("serial2", arrived_now());
  }

  static Task<void> read_while_ending(NodeFailures& test) {
    TestConductor conductor = test.conductor();
    co_await begun(test, conductor);
    co_await conductor.ask("prepare");
    co_await conductor.ask("start");
    test.cameras_->frame("serial2", arrived_now());
    co_await test.pause(2 * kJournalBatch);
    test.node_->stop();
    const NodeAnswer refused = co_await conductor.ask("start");
    EXPECT_THAT(refused.error, HasSubstr("the node is ending"));
    json place = in_session(kSession);
    place["offset"] = 0U;
    const NodeAnswer read = co_await conductor.ask("read", place);
    EXPECT_EQ(read.error, "");
    EXPECT_THAT(read.details.value("text", ""), HasSubstr("frame,"));
    EXPECT_FALSE(read.details.value("closed", true));
  }
};

TEST_F(NodeFailures, ASecondConductorIsToldWhoTheFirstIs) {
  make_node("3cam_1host_30fps");
  run(two_conductors(*this));
}

TEST_F(NodeFailures, AConductorThatVanishesEndsItsSession) {
  silence_ = from_ms(400);
  sync_ = SyncKind::kGoesOn;
  make_node("3cam_1host_30fps");
  run(vanish(*this));
}

TEST_F(NodeFailures, AConductorThatComesBackGoesOn) {
  silence_ = from_ms(800);
  make_node("3cam_1host_30fps");
  run(come_back(*this));
}

TEST_F(NodeFailures, ACameraThatRefusesIsAProblemAndTheOthersGoOn) {
  cameras_ =
      std::make_unique<MadeUpCameras>(std::vector<std::string>{"serial0", "serial1", "serial2"});
  cameras_->refusals["serial1"] = "no profile of 848x480 at 90 Hz";
  make_node("3cam_1host_30fps");
  run(refusing_camera(*this));
}

TEST_F(NodeFailures, ACameraThatIsNotThereIsSaidAtOnce) {
  cameras_ = std::make_unique<MadeUpCameras>(std::vector<std::string>{"serial0", "serial2"});
  try {
    make_node("3cam_1host_30fps");
    FAIL() << "nothing thrown";
  } catch (const CameraError& error) {
    EXPECT_THAT(error.what(), HasSubstr("host0: camera serial1: not found; connected to this "
                                        "host: serial0, serial2"));
  }
}

TEST_F(NodeFailures, AHostSyncThatThrowsIsANotice) {
  sync_ = SyncKind::kThrows;
  make_node("3cam_1host_30fps");
  run(throwing_sync(*this));
}

TEST_F(NodeFailures, AHostIsNoPeerOfItself) {
  make_node("6cam_2host_30fps");
  run(itself_as_a_peer(*this));
}

TEST_F(NodeFailures, AHostSyncThatDoesNotEndLeavesTheClockToTheNextSession) {
  sync_ = SyncKind::kClings;
  make_node("3cam_1host_30fps");
  run(clinging_sync(*this));
}

TEST_F(NodeFailures, TermsThatCannotBeAreRefused) {
  make_node("3cam_1host_30fps");
  run(bad_terms(*this));
}

TEST_F(NodeFailures, NonsenseEndsItsOwnConnectionOnly) {
  make_node("3cam_1host_30fps");
  run(nonsense(*this));
}

// Whoever fetches a journal goes on with the node that comes next, and is not to give up before.
TEST_F(NodeFailures, ANodeThatIsEndingStillHandsOutWhatItRecorded) {
  make_node("3cam_1host_30fps");
  cameras_->stop_takes = std::chrono::milliseconds(200);
  run(read_while_ending(*this));
}

TEST_F(NodeFailures, AStopEndsTheSessionAndTheContextRunsOutOfWork) {
  sync_ = SyncKind::kGoesOn;
  make_node("3cam_1host_30fps");
  run(capture_until_stopped(*this));
  stop_node();
  EXPECT_EQ(seen_.alive, 0);
  EXPECT_FALSE(cameras_->runs("serial2"));
  EXPECT_THAT(frames_of(journal()), SizeIs(1));
  EXPECT_THAT(logged(), HasSubstr("the node is stopped"));
}

}  // namespace
}  // namespace simbench::hardware
