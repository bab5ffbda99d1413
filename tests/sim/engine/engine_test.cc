#include "sim/engine/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "tests/sim/engine/recorder.h"

namespace simbench::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Engine, ExecutesInOrderOfTime) {
  Engine engine;
  Recorder recorder(engine);
  recorder.schedule(30, 3, 7);
  recorder.schedule(10, 1, 8);
  recorder.schedule(20, 2, 9);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2, 3));
  EXPECT_EQ(recorder.events[0].time, at_ns(10));
  EXPECT_EQ(recorder.events[0].kind, 8);
  EXPECT_EQ(engine.now(), at_ns(30));
  EXPECT_EQ(engine.events(), 3);
  EXPECT_EQ(engine.pending(), 0);
}

TEST(Engine, ExecutesEqualTimesInOrderOfScheduling) {
  Engine engine;
  Recorder recorder(engine);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    recorder.schedule(5, i);
    expected.push_back(i);
  }
  engine.run();
  EXPECT_EQ(recorder.subjects, expected);
}

TEST(Engine, ExecutesWhatAnEventSchedulesForNowAfterWhatWasScheduledBefore) {
  Engine engine;
  Recorder recorder(engine);
  recorder.on_event = [&](const Event& event) {
    if (event.subject == 1) recorder.schedule(5, 3);
  };
  recorder.schedule(5, 1);
  recorder.schedule(5, 2);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2, 3));
}

TEST(Engine, KeepsEventsAndCallbacksInOneOrder) {
  Engine engine;
  Recorder recorder(engine);
  recorder.schedule(5, 1);
  engine.call_at(at_ns(5), [&] { recorder.subjects.push_back(2); });
  recorder.schedule(5, 3);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2, 3));
}

TEST(Engine, GivesEachHandlerItsOwnEvents) {
  Engine engine;
  Recorder first(engine);
  Recorder second(engine);
  first.schedule(1, 10);
  second.schedule(2, 20);
  engine.run();
  EXPECT_THAT(first.subjects, ElementsAre(10));
  EXPECT_THAT(second.subjects, ElementsAre(20));
}

TEST(Engine, StartsBelowZero) {
  Engine engine({}, at_ns(-1'000));
  Recorder recorder(engine);
  EXPECT_EQ(engine.now(), at_ns(-1'000));
  recorder.schedule(5, 3);
  recorder.schedule(-1'000, 1);
  recorder.schedule(-1, 2);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2, 3));
}

TEST(Engine, RunUntilStopsBeforeItsEndAndMovesTimeThere) {
  Engine engine;
  Recorder recorder(engine);
  recorder.schedule(9, 1);
  recorder.schedule(10, 2);
  engine.run_until(at_ns(10));
  EXPECT_THAT(recorder.subjects, ElementsAre(1));
  EXPECT_EQ(engine.now(), at_ns(10));
  engine.run_until(at_ns(11));
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2));
  engine.run_until(at_ns(50));
  EXPECT_EQ(engine.now(), at_ns(50));
}

TEST(Engine, StopLeavesAfterTheCurrentEvent) {
  Engine engine;
  Recorder recorder(engine);
  recorder.on_event = [&](const Event& event) {
    if (event.subject == 1) engine.stop();
  };
  recorder.schedule(1, 1);
  recorder.schedule(2, 2);
  engine.run_until(at_ns(10));
  EXPECT_THAT(recorder.subjects, ElementsAre(1));
  EXPECT_EQ(engine.now(), at_ns(1));
  EXPECT_EQ(engine.pending(), 1);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2));
}

TEST(Engine, WhatAHandlerThrowsLeavesRunAndTheEngineGoesOn) {
  Engine engine;
  Recorder recorder(engine);
  recorder.on_event = [](const Event& event) {
    if (event.subject == 1) throw std::runtime_error("broken camera");
  };
  recorder.schedule(1, 1);
  recorder.schedule(2, 2);
  EXPECT_THROW(engine.run(), std::runtime_error);
  EXPECT_EQ(engine.events(), 1);
  engine.run();
  EXPECT_THAT(recorder.subjects, ElementsAre(1, 2));
}

TEST(EngineLimits, EndARunOfTooManyEvents) {
  Engine engine({.max_events = 100});
  Recorder recorder(engine);
  recorder.on_event = [&](const Event& event) { recorder.schedule(0, event.subject + 1); };
  recorder.schedule(0, 0);
  try {
    engine.run();
    FAIL() << "the run ended";
  } catch (const EngineLimitReached& error) {
    EXPECT_THAT(error.what(), HasSubstr("limit of 100 events"));
    EXPECT_THAT(error.what(), HasSubstr("at 0 s after 100 events, 1 pending"));
  }
  EXPECT_EQ(engine.events(), 100);
}

TEST(EngineLimits, ARunOfExactlyTheAllowedEventsEnds) {
  Engine engine({.max_events = 2, .max_time = at_ns(2)});
  Recorder recorder(engine);
  recorder.schedule(1);
  recorder.schedule(2);
  EXPECT_NO_THROW(engine.run());
}

TEST(EngineLimits, EndARunThatGetsTooLate) {
  Engine engine({.max_time = TrueTime(std::chrono::seconds(2))});
  Recorder recorder(engine);
  recorder.schedule(1'500'000'000);
  recorder.schedule(2'000'000'001);
  engine.set_wait_reporter([] { return std::vector<std::string>{"host3: receive"}; });
  try {
    engine.run();
    FAIL() << "the run ended";
  } catch (const EngineLimitReached& error) {
    EXPECT_THAT(error.what(), HasSubstr("limit of virtual time, 2 s"));
    EXPECT_THAT(error.what(), HasSubstr("at 1.5 s after 1 events, 1 pending"));
    EXPECT_THAT(error.what(), HasSubstr("host3: receive"));
  }
}

TEST(EngineLimits, HoldInRunUntilOnlyForEventsBeforeItsEnd) {
  Engine engine({.max_time = at_ns(10)});
  Recorder recorder(engine);
  recorder.schedule(15);
  EXPECT_NO_THROW(engine.run_until(at_ns(15)));
  EXPECT_EQ(engine.now(), at_ns(15));
  EXPECT_THROW(engine.run_until(at_ns(16)), EngineLimitReached);
}

TEST(EngineLimits, DoNotHoldForCancelledCallbacks) {
  Engine engine({.max_time = at_ns(10)});
  const TimerId id = engine.call_at(at_ns(15), [] {});
  engine.cancel(id);
  EXPECT_NO_THROW(engine.run());
  EXPECT_NO_THROW(engine.run_until(at_ns(20)));
}

std::uint64_t hash_of(std::vector<Event> events) {
  Engine engine;
  Recorder first(engine);
  Recorder second(engine);
  for (const Event& e : events)
    (e.handler == 0 ? first : second)
        .schedule(e.time.time_since_epoch().count(), e.subject, e.kind);
  engine.run();
  return engine.trace_hash();
}

TEST(TraceHash, DependsOnEveryPartOfEveryEventAndOnTheirOrder) {
  const std::vector<Event> base = {{at_ns(5), 0, 1, 2}, {at_ns(5), 0, 3, 4}, {at_ns(6), 1, 0, 0}};
  const std::uint64_t hash = hash_of(base);
  EXPECT_EQ(hash_of(base), hash);
  std::vector<std::vector<Event>> others(7, base);
  others[0][1].time = at_ns(4);
  others[1][1].handler = 1;
  others[2][1].kind = 4;
  others[3][1].subject = 5;
  std::swap(others[4][0], others[4][1]);
  others[5].pop_back();
  others[6].push_back({at_ns(7), 0, 0, 0});
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_NE(hash_of(others[i]), hash) << i;
}

TEST(TraceHash, CountsCallbacksButNotTheirSlots) {
  Engine plain;
  plain.call_at(at_ns(5), [] {});
  plain.run();
  EXPECT_NE(plain.trace_hash(), Engine().trace_hash());

  Engine other_slot;
  const TimerId id = other_slot.call_at(at_ns(1), [] {});
  other_slot.call_at(at_ns(5), [] {});
  other_slot.cancel(id);
  other_slot.run();
  EXPECT_EQ(other_slot.trace_hash(), plain.trace_hash());
}

// The hash that scenarios record; it must not change from one compiler or version to the next.
TEST(TraceHash, HasItsGoldenValue) {
  EXPECT_EQ(hash_of({{at_ns(5), 0, 1, 2}, {at_ns(5), 0, 3, 4}, {at_ns(6), 1, 0, 0}}),
            7250506592643354575U);
}

TEST(EngineDeathTest, StopsAtProgrammingErrors) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Engine engine({}, at_ns(100));
  Recorder recorder(engine);
  EXPECT_DEATH(recorder.schedule(99), "in the past");
  EXPECT_DEATH(engine.call_at(at_ns(99), [] {}), "in the past");
  EXPECT_DEATH(engine.schedule(at_ns(100), 1, 0, 0), "not attached");
  EXPECT_DEATH(engine.run_until(at_ns(99)), "backwards");
  recorder.on_event = [&](const Event&) { engine.run(); };
  recorder.schedule(100);
  EXPECT_DEATH(engine.run(), "must not run the engine");
}

TEST(Engine, StopsSoonOnceItIsCancelled) {
  std::atomic<bool> cancel = false;
  Engine engine({.cancel = &cancel});
  Recorder recorder(engine);
  recorder.schedule(0, 0);
  recorder.on_event = [&](const Event& event) {
    if (event.subject == 10) cancel = true;
    recorder.schedule(event.time.time_since_epoch().count() + 1, event.subject + 1);
  };
  engine.run();
  EXPECT_GT(engine.events(), 10U);
  EXPECT_LT(engine.events(), 5000U);
  engine.run();
  EXPECT_LT(engine.events(), 5000U);
}

}  // namespace
}  // namespace simbench::sim
