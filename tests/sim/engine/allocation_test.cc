// How often the engine and the virtual executor allocate in steady state.
#include <gtest/gtest.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "sim/engine/engine.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "tests/sim/engine/counting_new.h"
#include "tests/sim/engine/recorder.h"

namespace simbench::sim {
namespace {

namespace asio = boost::asio;

// Reschedules each event after a random delay.
class Timers : public EventHandler {
 public:
  explicit Timers(Engine& engine) : engine_(engine), id_(engine.attach(*this)) {}
  void add(std::uint32_t timer) { engine_.schedule(next(), id_, 0, timer); }
  void handle(Event event) override { add(event.subject); }

 private:
  TrueTime next() {
    return engine_.now() + Nanoseconds(static_cast<std::int64_t>(random_.exponential(1e6)));
  }

  Engine& engine_;
  HandlerId id_;
  RandomStream random_{1, "timers"};
};

class AllocationPerEvent : public testing::TestWithParam<std::uint32_t> {};

TEST_P(AllocationPerEvent, TypedEventsTakeNone) {
  Engine engine;
  Timers timers(engine);
  for (std::uint32_t i = 0; i < GetParam(); ++i) timers.add(i);
  engine.run_until(TrueTime(Nanoseconds(100'000'000)));
  const std::uint64_t before = allocations();
  const std::uint64_t events = engine.events();
  engine.run_until(TrueTime(Nanoseconds(200'000'000)));
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_GT(engine.events() - events, 50 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(TournamentAndLadder, AllocationPerEvent, testing::Values(10, 400, 9000));

// Calls itself again and sets and cancels a deadline each time, as a waiting host does.
struct Repeater {
  Engine& engine;
  std::array<std::uint64_t, 4> data{};
  TimerId deadline = {};

  void repeat() {
    engine.cancel(deadline);
    deadline =
        engine.call_at(engine.now() + Nanoseconds(1'000'000), [this, copy = data] { data = copy; });
    engine.call_at(engine.now() + Nanoseconds(100), [this] { repeat(); });
  }
};

TEST(Allocation, CallbacksTakeNone) {
  Engine engine;
  Repeater repeater{.engine = engine};
  repeater.repeat();
  engine.run_until(at_ns(1'000'000));
  const std::uint64_t before = allocations();
  engine.run_until(at_ns(1'900'000));
  EXPECT_EQ(allocations() - before, 0);
}

constexpr int kAwaits = 1000;

asio::awaitable<void> sleep_often(VirtualContext& context, std::uint64_t& count) {
  for (int i = 0; i < 2 * kAwaits; ++i) {
    if (i == kAwaits) count = allocations();
    co_await sleep_until(context, context.engine().now() + Nanoseconds(10), "test");
  }
  count = allocations() - count;
}

TEST(Allocation, SleepsTakeNone) {
  Engine engine;
  VirtualContext context(engine);
  std::uint64_t count = 0;
  asio::co_spawn(context, sleep_often(context, count), asio::detached);
  engine.run();
  EXPECT_EQ(count, 0);
}

asio::awaitable<void> wait_often(VirtualContext& context, WaitPoint& point, std::uint64_t& count) {
  for (int i = 0; i < 2 * kAwaits; ++i) {
    if (i == kAwaits) count = allocations();
    context.post([&point] { point.notify(); });
    co_await point.wait(context.engine().now() + Nanoseconds(1'000'000));
  }
  count = allocations() - count;
}

TEST(Allocation, WaitsTakeNone) {
  Engine engine;
  VirtualContext context(engine);
  WaitPoint point(context, "test");
  std::uint64_t count = 0;
  asio::co_spawn(context, wait_often(context, point, count), asio::detached);
  engine.run();
  EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace simbench::sim
