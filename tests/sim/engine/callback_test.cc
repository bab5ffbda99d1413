// Callbacks of the engine: Engine::call_at and Engine::cancel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sim/engine/engine.h"
#include "tests/sim/engine/recorder.h"

namespace simbench::sim {
namespace {

using testing::ElementsAre;

// A capture that counts how many of its copies and moves are alive, and how often one was called.
class Tracer {
 public:
  explicit Tracer(int& alive) : alive_(&alive) { ++*alive_; }
  Tracer(const Tracer& other) : alive_(other.alive_) { ++*alive_; }
  Tracer& operator=(const Tracer&) = delete;
  ~Tracer() { --*alive_; }

 private:
  int* alive_;
};

TEST(Callback, RunsOnceAtItsTime) {
  Engine engine;
  std::vector<TrueTime> times;
  engine.call_at(at_ns(7), [&] { times.push_back(engine.now()); });
  engine.run();
  EXPECT_THAT(times, ElementsAre(at_ns(7)));
  EXPECT_EQ(engine.events(), 1);
}

TEST(Callback, TakesMoveOnlyCaptures) {
  Engine engine;
  int result = 0;
  engine.call_at(at_ns(1), [value = std::make_unique<int>(42), &result] { result = *value; });
  engine.run();
  EXPECT_EQ(result, 42);
}

TEST(Callback, TakesCapturesOf48Bytes) {
  Engine engine;
  std::array<std::uint64_t, 5> numbers = {1, 2, 3, 4, 5};
  std::uint64_t sum = 0;
  engine.call_at(at_ns(1), [numbers, &sum] {
    for (const std::uint64_t number : numbers) sum += number;
  });
  engine.run();
  EXPECT_EQ(sum, 15);
}

TEST(Callback, CaptureIsDestroyedAfterItsCall) {
  int alive = 0;
  Engine engine;
  int alive_in_call = 0;
  engine.call_at(at_ns(1),
                 [tracer = Tracer(alive), &alive, &alive_in_call] { alive_in_call = alive; });
  EXPECT_EQ(alive, 1);
  engine.run();
  EXPECT_EQ(alive_in_call, 1);
  EXPECT_EQ(alive, 0);
}

TEST(Callback, CaptureIsDestroyedWhenTheCallThrows) {
  int alive = 0;
  Engine engine;
  const TimerId id =
      engine.call_at(at_ns(1), [tracer = Tracer(alive)] { throw std::runtime_error("no"); });
  EXPECT_THROW(engine.run(), std::runtime_error);
  EXPECT_EQ(alive, 0);
  EXPECT_FALSE(engine.cancel(id));
}

TEST(Callback, CaptureIsDestroyedWhenCancelled) {
  int alive = 0;
  Engine engine;
  const TimerId id = engine.call_at(at_ns(1), [tracer = Tracer(alive)] { FAIL(); });
  EXPECT_TRUE(engine.cancel(id));
  EXPECT_EQ(alive, 0);
  engine.run();
  EXPECT_EQ(engine.events(), 0);
}

TEST(Callback, CaptureIsDestroyedWithTheEngine) {
  int alive = 0;
  {
    Engine engine;
    for (int i = 0; i < 20; ++i) engine.call_at(at_ns(i), [tracer = Tracer(alive)] {});
    EXPECT_EQ(alive, 20);
  }
  EXPECT_EQ(alive, 0);
}

TEST(Callback, MayScheduleAndCancelOthers) {
  Engine engine;
  std::vector<int> calls;
  TimerId victim;
  engine.call_at(at_ns(1), [&] {
    calls.push_back(1);
    for (int i = 0; i < 100; ++i) engine.call_at(at_ns(2), [] {});
    victim = engine.call_at(at_ns(3), [&] { calls.push_back(3); });
  });
  engine.call_at(at_ns(2), [&] {
    calls.push_back(2);
    EXPECT_TRUE(engine.cancel(victim));
  });
  engine.run();
  EXPECT_THAT(calls, ElementsAre(1, 2));
}

TEST(Cancel, IsFalseForWhatIsNotPending) {
  Engine engine;
  EXPECT_FALSE(engine.cancel(TimerId()));
  TimerId id;
  bool cancelled_itself = true;
  id = engine.call_at(at_ns(1), [&] { cancelled_itself = engine.cancel(id); });
  engine.run();
  EXPECT_FALSE(cancelled_itself);
  EXPECT_FALSE(engine.cancel(id));
  const TimerId next = engine.call_at(at_ns(2), [] {});  // in the same slot
  EXPECT_FALSE(engine.cancel(id));
  EXPECT_TRUE(engine.cancel(next));
  EXPECT_FALSE(engine.cancel(next));
}

TEST(Cancel, LeavesTimeAndCountAlone) {
  Engine engine;
  engine.call_at(at_ns(1), [] {});
  const TimerId id = engine.call_at(at_ns(5), [] {});
  EXPECT_EQ(engine.pending(), 2);
  engine.cancel(id);
  EXPECT_EQ(engine.pending(), 1);
  engine.run();
  EXPECT_EQ(engine.now(), at_ns(1));
  EXPECT_EQ(engine.events(), 1);
  EXPECT_EQ(engine.pending(), 0);
}

// As deadlines do: set far ahead and almost always cancelled.
TEST(Cancel, OfManyKeepsTheOthersInOrder) {
  Engine engine;
  std::vector<std::int64_t> fired;
  std::vector<std::int64_t> expected;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    const std::int64_t time_ns = 1'000'000 + (i * 7919) % 20'011;
    const TimerId id =
        engine.call_at(at_ns(time_ns), [&fired, time_ns] { fired.push_back(time_ns); });
    if (i % 100 == 0) {
      expected.push_back(time_ns);
    } else {
      ASSERT_TRUE(engine.cancel(id));
    }
  }
  EXPECT_EQ(engine.pending(), expected.size());
  engine.run();
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(fired, expected);
}

TEST(Cancel, ByTheDestructorOfACaptureIsFine) {
  struct CancelOnDestruction {
    Engine* engine;
    TimerId id;
    CancelOnDestruction(Engine& e, TimerId timer) : engine(&e), id(timer) {}
    CancelOnDestruction(CancelOnDestruction&& other) noexcept
        : engine(std::exchange(other.engine, nullptr)), id(other.id) {}
    ~CancelOnDestruction() {
      if (engine != nullptr) engine->cancel(id);
    }
  };
  int alive = 0;
  {
    Engine engine;
    const TimerId inner = engine.call_at(at_ns(5), [tracer = Tracer(alive)] {});
    engine.call_at(at_ns(9), [guard = CancelOnDestruction(engine, inner)] {});
  }
  EXPECT_EQ(alive, 0);
}

}  // namespace
}  // namespace simbench::sim
