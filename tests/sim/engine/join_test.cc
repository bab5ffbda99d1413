// algorithms/host_sync/join.h on the engine's executor, which posts all that others do at once.

#include "algorithms/host_sync/join.h"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/engine/virtual_executor.h"

namespace simbench::sim {
namespace {

class JoinTest : public testing::Test {
 protected:
  // Ends after so long, then throws unless `what` is empty. Zero: does not wait at all.
  Task<void> task(Nanoseconds length, std::string what) {
    if (length.count() > 0) {
      co_await sleep_until(context, engine.now() + length, "task");
    }
    ++ended;
    if (!what.empty()) throw std::runtime_error(what);
  }

  // What the join throws; empty: nothing.
  std::string thrown_by(std::vector<Task<void>> tasks) {
    std::string thrown = "never ended";
    boost::asio::co_spawn(context, join_all(std::move(tasks)),
                          [&thrown](const std::exception_ptr& failure) {
                            thrown.clear();
                            try {
                              if (failure) std::rethrow_exception(failure);
                            } catch (const std::exception& error) {
                              thrown = error.what();
                            }
                          });
    engine.run();
    EXPECT_EQ(context.live(), 0U);
    return thrown;
  }

  Engine engine;
  VirtualContext context{engine};
  int ended = 0;
};

TEST_F(JoinTest, WaitsForAll) {
  std::vector<Task<void>> tasks;
  tasks.push_back(task(from_ms(5), ""));
  tasks.push_back(task(from_ms(0), ""));
  tasks.push_back(task(from_ms(9), ""));
  EXPECT_EQ(thrown_by(std::move(tasks)), "");
  EXPECT_EQ(ended, 3);
  EXPECT_EQ(engine.now(), TrueTime(from_ms(9)));
}

TEST_F(JoinTest, TheFirstFailureCancelsTheOthers) {
  std::vector<Task<void>> tasks;
  tasks.push_back(task(from_ms(9), "late"));
  tasks.push_back(task(from_ms(5), "early"));
  tasks.push_back(task(from_ms(1), ""));
  EXPECT_EQ(thrown_by(std::move(tasks)), "early");
  EXPECT_EQ(ended, 2);
  EXPECT_EQ(engine.now(), TrueTime(from_ms(5)));
}

// All cancellations are under way when the group ends.
TEST_F(JoinTest, FailuresAtOneInstantAreTheFirstOnes) {
  for (const double length_ms : {0.0, 5.0}) {
    for (const bool all_fail : {true, false}) {
      std::vector<Task<void>> tasks;
      tasks.push_back(task(from_ms(length_ms), "first"));
      tasks.push_back(task(from_ms(length_ms), all_fail ? "second" : ""));
      tasks.push_back(task(from_ms(length_ms), all_fail ? "third" : ""));
      EXPECT_EQ(thrown_by(std::move(tasks)), "first");
    }
  }
  EXPECT_EQ(ended, 12);
}

TEST_F(JoinTest, TheLastOneMayFail) {
  std::vector<Task<void>> tasks;
  tasks.push_back(task(from_ms(0), ""));
  tasks.push_back(task(from_ms(5), ""));
  tasks.push_back(task(from_ms(5), "last"));
  EXPECT_EQ(thrown_by(std::move(tasks)), "last");
  EXPECT_EQ(ended, 3);
}

}  // namespace
}  // namespace simbench::sim
