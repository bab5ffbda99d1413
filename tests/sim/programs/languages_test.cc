// Programs of other languages and libraries, with the threads, timers, sockets and children that
// these have: what ends when, in simulated time. Each is run twice.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/scratch_folder.h"
#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {
namespace {

// When something ended, ms, and what.
using Said = std::pair<double, std::string>;

std::vector<Said> said_in(const std::string& text) {
  std::vector<Said> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t space = line.find(' ');
    lines.emplace_back(std::atof(line.c_str()), line.substr(std::min(space, line.size() - 1) + 1));
  }
  return lines;
}

class Languages : public RealPrograms {
 protected:
  // A slave's program says this; each exchange of messages takes some 0.3 ms.
  void expect_said(const std::string& log, const std::vector<Said>& expected) const {
    const std::vector<Said> said = said_in(file(1, log));
    ASSERT_EQ(said.size(), expected.size()) << file(1, log);
    for (std::size_t i = 0; i < nonempty(expected).size(); ++i) {
      EXPECT_EQ(said[i].second, expected[i].second);
      EXPECT_NEAR(said[i].first, expected[i].first, 3) << expected[i].second;
    }
  }
};

TEST_F(Languages, ThreadsOfPythonWaitInTheWorldsTime) {
  SIMBENCH_SKIP_WITHOUT("python3");
  const Command command{"python3", test_script("threads.py")};
  run_twice(settings({command}, {command}), two_hosts(), 60);
  expect_said("0_python3.log", {{250, "wait False"},
                                {350, "wait True"},
                                {500, "items [0, 1, 2, 3, 4]"},
                                {700, "empty"},
                                {750, "lock False"},
                                {770, "lock True"},
                                {840, "met"},
                                {1140, "squares [0, 1, 4, 9, 16]"}});
}

TEST_F(Languages, TasksOfAsyncioAskAnotherHost) {
  SIMBENCH_SKIP_WITHOUT("python3");
  const std::string script = test_script("tasks.py");
  run_twice(settings({{"python3", script, "serve"}}, {{"python3", script, "ask", "host0"}}),
            two_hosts(), 60);
  expect_said("0_python3.log", {{0, "b'datagram'"},
                                {1, "b'stream\\n'"},
                                {101, "slept 0.1"},
                                {201, "slept 0.2"},
                                {301, "slept 0.3"},
                                {451, "patience is over"},
                                {701, "of a thread"},
                                {1201, "b'of a child\\n' 3"},
                                {1251, "called"}});
}

TEST_F(Languages, ChildrenOfPythonEndInTheWorldsTime) {
  SIMBENCH_SKIP_WITHOUT("python3");
  const Command command{"python3", test_script("children.py")};
  run_twice(settings({command}, {command}), two_hosts(), 60);
  expect_said("0_python3.log", {{200, "4 b'out\\n' b'err\\n'"},
                                {500, "patience is over"},
                                {500, "b'a\\nb\\n'"},
                                {600, "line 0"},
                                {700, "line 1"},
                                {800, "line 2"},
                                {800, "ended 0"},
                                {850, "running None"},
                                {850, "ended -15"},
                                {950, "fork 7"},
                                {1150, "pool [0, 1, 4, 9]"}});
}

TEST_F(Languages, NodeHasTimersSocketsThreadsAndChildren) {
  SIMBENCH_SKIP_WITHOUT("node");
  const std::string script = test_script("workers.js");
  run_twice(settings({{"node", script, "serve"}}, {{"node", script, "ask", "{master}"}}),
            two_hosts(), 60);
  expect_said("0_node.log", {{0, "datagram"},
                             {250, "timeout"},
                             {400, "interval 3"},
                             {600, "of a worker"},
                             {900, "of a child"},
                             {900, "text"}});
}

TEST_F(Languages, RustHasThreadsSocketsAndChildren) {
  const char* home = std::getenv("HOME");
  const std::string own = home != nullptr ? std::string(home) + "/.cargo/bin/rustc" : "";
  const std::string compiler = std::filesystem::exists(own) ? own : "rustc";
  const ScratchFolder folder;
  const std::string program = folder / "threads";
  const std::string compile = fmt::format("{} -o {} {}threads.rs > {} 2>&1", compiler, program,
                                          test_script(""), folder / "said");
  if (std::system((compiler + " --version > /dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "rustc is not there";
  }
  ASSERT_EQ(std::system(compile.c_str()), 0) << folder.content("said");
  run_twice(settings({{program, "serve"}}, {{program, "ask", "{master}"}}), two_hosts(), 60);
  expect_said("0_threads.log", {{0, "datagram"},
                                {150, "WouldBlock"},
                                {151, "stream"},
                                {451, "[2, 1, 0]"},
                                {651, "time is up: true"},
                                {951, "of a child"}});
}

// A way takes 0.1 ms and an exponential 0.05 ms, so that the mean of 200 round trips is 0.3 ms with
// a deviation of 0.005 ms.
TEST_F(Languages, AnAsioServerOfThreeThreadsAnswers) {
  const std::string program = test_program("asio_echo");
  run_twice(settings({{program, "serve"}}, {{program, "ask", "host0"}}), two_hosts(), 60);
  double round_trip_ms = 0;
  double vain_ms = 0;
  const std::string said = file(1, "0_simbench_asio_echo.log");
  ASSERT_EQ(std::sscanf(said.c_str(), "hello: round trip %lf ms, in vain %lf ms", &round_trip_ms,
                        &vain_ms),
            2)
      << said;
  EXPECT_NEAR(round_trip_ms, 0.3, 0.025);
  EXPECT_NEAR(vain_ms, 250, 0.05);
}

// 300 frames at 50 Hz with a second between; three workers who wait for 100 ms at most find nothing
// ten times in it. A frame arrives 5 ms of encoding and a way after its stamp.
TEST_F(Languages, ACaptureServerPublishesWhatItsCameraStamped) {
  const std::string program = test_program("capture_server");
  run_twice(settings({{program, "subscribe"}}, {{program, "publish", "{master}"}}), two_hosts(),
            60);
  EXPECT_EQ(file(1, "0_simbench_capture_server.log"), "sent 300 frames, found nothing 30 times\n");
  std::istringstream arrivals(file(0, "0_simbench_capture_server.log"));
  int number = 0;
  double stamped_ms = 0;
  double arrived_ms = 0;
  double late_ms = 0;
  int next = 0;
  for (; arrivals >> number >> stamped_ms >> arrived_ms; ++next) {
    ASSERT_EQ(number, next);
    // By one quartz: as long as it says, but for readings of 20 ns.
    EXPECT_NEAR(stamped_ms, number * 20.0 + (number < 100 ? 0 : 1000), 0.005);
    late_ms += arrived_ms - stamped_ms;
  }
  EXPECT_EQ(next, 300);
  // The first arrival's own exponential is in all differences, and 7 s of two quartzes of 10 ppm.
  EXPECT_NEAR(late_ms / 300, 0, 0.05 * 8 + 7e3 * 50e-6);
}

}  // namespace
}  // namespace simbench::sim
