// Real programs around a node's software clock.
#include "hardware/node/node_programs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/co_spawn.hpp>
#include <string>
#include <variant>
#include <vector>

#include "tests/hardware/await.h"
#include "tests/hardware/node/host_pair.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class NodeProgramsTest : public testing::Test {
 protected:
  // Runs a program as host 1's until it ends; returns how.
  std::string run(const std::vector<std::string>& command) {
    NodePrograms programs({.programs = {.master = {}, .slave = {command}, .files = {}},
                           .shim = SIMBENCH_SHIM,
                           .log_folder = folder_.path().string()});
    boost::asio::cancellation_signal cancel;
    bool done = false;
    boost::asio::co_spawn(pair_.context(), programs.run_slave(pair_.host(1), 0),
                          boost::asio::bind_cancellation_slot(
                              cancel.slot(), [&](const std::exception_ptr&) { done = true; }));
    run_until(pair_.context(), [&] { return done || outcome() != nullptr; });
    const std::string message = outcome() != nullptr ? outcome()->message : "";
    cancel.emit(boost::asio::cancellation_type::terminal);
    run_until(pair_.context(), [&] { return done; });
    return message;
  }
  std::string output() const { return folder_.content("host1/0_simbench_clock_calls.log"); }

  const SyncOutcome* outcome() const {
    for (const RecordingEvent& event : pair_.events(1)) {
      if (const auto* found = std::get_if<SyncOutcome>(&event)) return found;
    }
    return nullptr;
  }

  ScratchFolder folder_;
  HostPair pair_{std::chrono::seconds(1), 0, 100};
};

TEST_F(NodeProgramsTest, AllReadingsAndStampsAreOfTheHostsClock) {
  const std::string ending = run({std::string(SIMBENCH_PROGRAMS) + "/simbench_clock_calls"});
  EXPECT_EQ(output(), "done\n");
  EXPECT_THAT(ending, HasSubstr("host 1: simbench_clock_calls: exited with status 0"));
  const auto is_adjustment = [](const RecordingEvent& event) {
    return std::holds_alternative<ClockAdjustment>(event);
  };
  const auto& events = pair_.events(1);
  EXPECT_GE(std::count_if(events.begin(), events.end(), is_adjustment), 5)
      << "what the program does to the clock is on record";
}

TEST_F(NodeProgramsTest, NoClockOfTheMachineCanBeSet) {
  const std::string ending =
      run({std::string(SIMBENCH_PROGRAMS) + "/simbench_escapes", "clock_settime"});
  EXPECT_THAT(ending, MatchesRegex(".*clock_settime\\(.*\\) was not intercepted.*"));
}

}  // namespace
}  // namespace simbench::hardware
