#include "sim/engine/virtual_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/multiple_exceptions.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/sim/engine/recorder.h"

namespace simbench::sim {
namespace {

namespace asio = boost::asio;
using asio::experimental::awaitable_operators::operator||;
using asio::experimental::awaitable_operators::operator&&;
using testing::ElementsAre;
using testing::HasSubstr;

class VirtualExecutorTest : public testing::Test {
 protected:
  void spawn(asio::awaitable<void> coroutine) {
    asio::co_spawn(context, std::move(coroutine), [](std::exception_ptr error) {
      if (error) std::rethrow_exception(error);
    });
  }
  std::int64_t now_ns() { return engine.now().time_since_epoch().count(); }

  Engine engine;
  VirtualContext context{engine};
  std::vector<std::string> log;
  std::vector<std::int64_t> times_ns;
};

TEST_F(VirtualExecutorTest, PostedWorkRunsNowInOrderAndNotNested) {
  asio::post(context, [this] {
    log.emplace_back("a begins");
    asio::post(context, [this] { log.emplace_back("c"); });
    log.emplace_back("a ends");
  });
  asio::post(context, [this] { log.emplace_back("b"); });
  EXPECT_TRUE(log.empty());
  engine.run();
  EXPECT_THAT(log, ElementsAre("a begins", "a ends", "b", "c"));
  EXPECT_EQ(engine.now(), TrueTime{});
}

TEST_F(VirtualExecutorTest, PostedWorkMayBeLargerThanACallback) {
  std::array<std::uint64_t, 20> numbers{};
  numbers[19] = 7;
  context.post([this, numbers] { times_ns.push_back(static_cast<std::int64_t>(numbers[19])); });
  engine.run();
  EXPECT_THAT(times_ns, ElementsAre(7));
}

TEST_F(VirtualExecutorTest, ExecutorsOfOneContextAreEqual) {
  Engine other_engine;
  VirtualContext other(other_engine);
  EXPECT_EQ(context.get_executor(), context.get_executor());
  EXPECT_NE(asio::any_io_executor(context.get_executor()),
            asio::any_io_executor(other.get_executor()));
}

asio::awaitable<void> sleep_twice(VirtualContext& context, std::vector<std::int64_t>& times_ns) {
  for (const std::int64_t time_ns : {100, 250}) {
    co_await sleep_until(context, at_ns(time_ns), "test");
    times_ns.push_back(context.engine().now().time_since_epoch().count());
  }
  co_await sleep_until(context, at_ns(50), "past");
  times_ns.push_back(context.engine().now().time_since_epoch().count());
}

TEST_F(VirtualExecutorTest, SleepsUntilVirtualTime) {
  spawn(sleep_twice(context, times_ns));
  engine.run();
  EXPECT_THAT(times_ns, ElementsAre(100, 250, 250));
  EXPECT_EQ(context.live(), 0);
}

asio::awaitable<int> answer_after(VirtualContext& context, TrueTime at, int answer) {
  co_await sleep_until(context, at, "answer");
  if (answer < 0) throw std::runtime_error("no answer");
  co_return answer;
}

TEST_F(VirtualExecutorTest, CompletionHandlersGetResultsAndExceptions) {
  int result = 0;
  std::string error_text;
  asio::co_spawn(context, answer_after(context, at_ns(5), 42),
                 [&](std::exception_ptr, int answer) { result = answer; });
  asio::co_spawn(context, answer_after(context, at_ns(7), -1), [&](std::exception_ptr error, int) {
    try {
      std::rethrow_exception(error);
    } catch (const std::runtime_error& e) {
      error_text = e.what();
    }
  });
  asio::co_spawn(context, answer_after(context, at_ns(8), -1), asio::detached);
  engine.run();
  EXPECT_EQ(result, 42);
  EXPECT_EQ(error_text, "no answer");
}

asio::awaitable<void> log_wait(VirtualContext& context, WaitPoint& point,
                               std::optional<TrueTime> deadline, std::vector<std::string>& log) {
  try {
    const bool notified = co_await point.wait(deadline);
    log.push_back((notified ? "notified at " : "deadline at ") +
                  std::to_string(context.engine().now().time_since_epoch().count()));
  } catch (const boost::system::system_error& error) {
    log.emplace_back(error.code() == asio::error::operation_aborted ? "aborted" : "failed");
  }
}

TEST_F(VirtualExecutorTest, WaitPointIsNotifiedOrReachesItsDeadline) {
  WaitPoint point(context, "test");
  EXPECT_FALSE(point.waiting());
  spawn(log_wait(context, point, at_ns(10), log));
  engine.call_at(at_ns(4), [&] {
    EXPECT_TRUE(point.waiting());
    point.notify();
    EXPECT_FALSE(point.waiting());
    EXPECT_TRUE(log.empty()) << "resumed inside notify()";
  });
  engine.run();
  spawn(log_wait(context, point, at_ns(10), log));
  engine.run();
  spawn(log_wait(context, point, at_ns(3), log));  // past
  engine.run();
  EXPECT_THAT(log, ElementsAre("notified at 4", "deadline at 10", "deadline at 10"));
}

TEST_F(VirtualExecutorTest, NotifyWithoutAWaitIsNotRemembered) {
  WaitPoint point(context, "test");
  point.notify();
  spawn(log_wait(context, point, at_ns(10), log));
  engine.run();
  EXPECT_THAT(log, ElementsAre("deadline at 10"));
}

TEST_F(VirtualExecutorTest, OfNotifyAndDeadlineAtOneInstantTheFirstCounts) {
  WaitPoint point(context, "test");
  engine.call_at(at_ns(10), [&] { point.notify(); });  // before the deadline's event
  spawn(log_wait(context, point, at_ns(10), log));
  engine.run();
  spawn(log_wait(context, point, at_ns(20), log));
  engine.call_at(at_ns(15), [&] {  // after the deadline's event
    engine.call_at(at_ns(20), [&] { point.notify(); });
  });
  engine.run();
  EXPECT_THAT(log, ElementsAre("notified at 10", "deadline at 20"));
}

TEST_F(VirtualExecutorTest, DestroyingAWaitPointEndsItsWait) {
  auto point = std::make_unique<WaitPoint>(context, "test");
  spawn(log_wait(context, *point, std::nullopt, log));
  engine.call_at(at_ns(4), [&] { point.reset(); });
  engine.run();
  EXPECT_THAT(log, ElementsAre("aborted"));
}

// A mailbox as channels have one, and a pair of coroutines that talk through two of them.
class Mailbox {
 public:
  Mailbox(VirtualContext& context, std::string label) : arrived_(context, std::move(label)) {}
  void put(int value) {
    values_.push_back(value);
    arrived_.notify();
  }
  asio::awaitable<std::optional<int>> take(std::optional<TrueTime> deadline) {
    while (values_.empty()) {
      const bool notified = co_await arrived_.wait(deadline);
      if (!notified) co_return std::nullopt;
    }
    const int value = values_.front();
    values_.pop_front();
    co_return value;
  }

 private:
  std::deque<int> values_;
  WaitPoint arrived_;
};

asio::awaitable<void> count_up(Mailbox& in, Mailbox& out, int rounds, int& last) {
  for (int i = 0; i < rounds; ++i) {
    const std::optional<int> value = co_await in.take(std::nullopt);
    last = *value;
    out.put(last + 1);
  }
}

TEST_F(VirtualExecutorTest, CoroutinesTalkThroughMailboxes) {
  Mailbox a(context, "a");
  Mailbox b(context, "b");
  int last_a = 0;
  int last_b = 0;
  spawn(count_up(a, b, 1000, last_a));
  spawn(count_up(b, a, 1000, last_b));
  a.put(1);
  engine.run();
  EXPECT_EQ(last_a, 1999);
  EXPECT_EQ(last_b, 2000);
}

asio::awaitable<void> first_of(VirtualContext& context, WaitPoint& point,
                               std::vector<std::string>& log) {
  const auto first = co_await (point.wait()(asio::use_awaitable) ||
                               sleep_until(context, at_ns(10), "timeout")(asio::use_awaitable));
  log.push_back("first " + std::to_string(first.index()));
  const auto second = co_await (point.wait(at_ns(15))(asio::use_awaitable) ||
                                sleep_until(context, at_ns(99), "late")(asio::use_awaitable));
  log.push_back("second " + std::to_string(second.index()));
  co_await (sleep_until(context, at_ns(30), "x")(asio::use_awaitable) &&
            sleep_until(context, at_ns(20), "y")(asio::use_awaitable));
  log.push_back("both at " + std::to_string(context.engine().now().time_since_epoch().count()));
}

TEST_F(VirtualExecutorTest, OperatorsWaitForOneOrBothAndCancelTheLoser) {
  WaitPoint point(context, "test");
  spawn(first_of(context, point, log));
  engine.run();
  EXPECT_THAT(log, ElementsAre("first 1", "second 0", "both at 30"));
  EXPECT_EQ(engine.now(), at_ns(30)) << "the cancelled sleep until 99 must not move time";
  EXPECT_EQ(context.live(), 0);
}

asio::awaitable<void> fail_beside(VirtualContext& context, std::vector<std::string>& log) {
  try {
    co_await (answer_after(context, at_ns(5), -1) &&
              sleep_until(context, at_ns(1000), "long")(asio::use_awaitable));
  } catch (const asio::multiple_exceptions& errors) {  // the failure and the cancelled sleep
    try {
      std::rethrow_exception(errors.first_exception());
    } catch (const std::runtime_error& error) {
      log.emplace_back(error.what());
    }
  }
}

TEST_F(VirtualExecutorTest, AFailureCancelsTheOtherSide) {
  spawn(fail_beside(context, log));
  engine.run();
  EXPECT_THAT(log, ElementsAre("no answer"));
  EXPECT_EQ(engine.now(), at_ns(5));
}

TEST_F(VirtualExecutorTest, SaysWhatCoroutinesWaitFor) {
  WaitPoint receive(context, "host3: receive from host0");
  WaitPoint forever(context, "host1: receive from host0");
  engine.run_until(at_ns(12'345'678'000));
  spawn(log_wait(context, receive, TrueTime(std::chrono::seconds(17)), log));
  spawn(log_wait(context, forever, std::nullopt, log));
  engine.run_until(at_ns(12'400'000'000));
  EXPECT_EQ(context.live(), 2);
  EXPECT_THAT(context.waiting(),
              ElementsAre("host3: receive from host0, since 12.345678 s, deadline 17 s",
                          "host1: receive from host0, since 12.345678 s"));
  engine.run();
  EXPECT_THAT(context.waiting(), ElementsAre("host1: receive from host0, since 12.345678 s"));
}

asio::awaitable<void> busy(VirtualContext& context) {
  for (;;) co_await sleep_until(context, context.engine().now(), "busy");
}

TEST(VirtualContext, TellsTheLimitsMessageWhatCoroutinesWaitFor) {
  Engine engine({.max_events = 1000});
  VirtualContext context(engine);
  WaitPoint point(context, "host3: receive from host0");
  std::vector<std::string> log;
  asio::co_spawn(context, log_wait(context, point, std::nullopt, log), asio::detached);
  asio::co_spawn(context, busy(context), asio::detached);
  try {
    engine.run();
    FAIL() << "the run ended";
  } catch (const EngineLimitReached& error) {
    EXPECT_THAT(error.what(), HasSubstr("2 coroutines wait"));
    EXPECT_THAT(error.what(), HasSubstr("host3: receive from host0, since 0 s"));
  }
}

asio::awaitable<void> many_ready_awaits(VirtualContext& context, WaitPoint& point, int& count) {
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  for (int i = 0; i < 250'000; ++i) {
    co_await sleep_until(context, context.engine().now(), "ready");
    co_await asio::post(executor, asio::use_awaitable);
    context.post([&point] { point.notify(); });
    co_await point.wait();
    co_await point.wait(context.engine().now());
    count += 4;
  }
}

TEST_F(VirtualExecutorTest, AMillionReadyAwaitsNeedNoStack) {
  WaitPoint point(context, "test");
  int count = 0;
  spawn(many_ready_awaits(context, point, count));
  engine.run();
  EXPECT_EQ(count, 1'000'000);
}

asio::awaitable<void> hold_and_wait(VirtualContext& context, WaitPoint& point,
                                    std::shared_ptr<int> held) {
  co_await (point.wait()(asio::use_awaitable) ||
            sleep_until(context, TrueTime(std::chrono::hours(1)), "hour")(asio::use_awaitable));
  ++*held;
}

TEST(VirtualContext, DestroysWhatStillWaits) {
  const auto held = std::make_shared<int>(0);
  {
    Engine engine;
    VirtualContext context(engine);
    WaitPoint point(context, "never");
    WaitPoint resumed(context, "about to be resumed");
    asio::co_spawn(context, hold_and_wait(context, point, held), asio::detached);
    asio::co_spawn(context, hold_and_wait(context, resumed, held), asio::detached);
    engine.run_until(at_ns(10));
    resumed.notify();
    asio::co_spawn(context, hold_and_wait(context, point, held), asio::detached);  // not begun
    context.post([held] { ++*held; });
    EXPECT_GT(held.use_count(), 3);
  }
  EXPECT_EQ(held.use_count(), 1);
  EXPECT_EQ(*held, 0);
}

}  // namespace
}  // namespace simbench::sim
