#include "hardware/experiment/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <memory>
#include <string>

#include "hardware/experiment/experiment_rig.h"
#include "tests/read_fault.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;

MonotonicTime child_limit() { return monotonic_now() + std::chrono::seconds(20); }

class ChildProcessTest : public testing::Test {
 protected:
  ChildProcess::Settings shell(const std::string& script) const {
    return {.program = "/bin/sh",
            .arguments = {"-c", script},
            .log = folder_.file("log"),
            .sandbox_member = std::nullopt};
  }
  TemporaryFolder folder_;
};

bool is_alive(pid_t process) { return kill(process, 0) == 0; }

TEST_F(ChildProcessTest, ItsOutputIsReadByLine) {
  ChildProcess child(shell("echo one; printf 'two\\nthree'"));
  EXPECT_EQ(child.read_line(child_limit()), "one");
  EXPECT_EQ(child.read_line(child_limit()), "two");
  EXPECT_THROW(child.read_line(child_limit()), ChildError) << "no whole line is left";
}

TEST_F(ChildProcessTest, WhatItSaidLastIsInTheMessage) {
  ChildProcess child(shell("echo no such rig >&2; exit 3"));
  try {
    child.read_line(child_limit());
    FAIL() << "a line was read";
  } catch (const ChildError& error) {
    EXPECT_STREQ(error.what(), "simbench -c: ended before it was ready: no such rig");
  }
}

TEST_F(ChildProcessTest, ALogThatCannotBeReadIsNotTakenForAnEmptyOne) {
  const std::string last = "no such rig\n";
  ChildProcess child(shell("printf '" + last + "' >&2; exit 3"));
  for (std::size_t byte = 0; byte < last.size(); ++byte) {
    const ReadFault fault(byte);
    try {
      child.read_line(child_limit());
      FAIL() << "a line was read";
    } catch (const ChildError& error) {
      EXPECT_THAT(error.what(), HasSubstr("ended before it was ready: " + folder_.file("log") +
                                          ": cannot be read: "))
          << byte;
    }
  }
}

TEST_F(ChildProcessTest, WaitingHasALimit) {
  ChildProcess child(shell("sleep 60"));
  try {
    child.read_line(monotonic_now() + from_ms(20));
    FAIL() << "a line was read";
  } catch (const ChildError& error) {
    EXPECT_THAT(error.what(), HasSubstr("was not ready in time"));
  }
}

TEST_F(ChildProcessTest, EndsWithItsObject) {
  auto child = std::make_unique<ChildProcess>(shell("echo ready; exec sleep 60"));
  child->read_line(child_limit());
  const pid_t process = child->id();
  EXPECT_TRUE(is_alive(process));
  child.reset();
  EXPECT_FALSE(is_alive(process));
  EXPECT_EQ(waitpid(process, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD) << "its status was collected";
}

TEST_F(ChildProcessTest, IsKilledIfItDoesNotListen) {
  ChildProcess child(shell("trap '' TERM; echo ready; while :; do sleep 1; done"));
  child.read_line(child_limit());
  const pid_t process = child.id();
  child.end(from_ms(50));
  EXPECT_FALSE(is_alive(process));
}

TEST_F(ChildProcessTest, ItsLastWordsAreKept) {
  ChildProcess child(shell("trap 'echo bye; exit' TERM; echo ready; while :; do sleep 0.01; done"));
  child.read_line(child_limit());
  EXPECT_EQ(child.end(std::chrono::seconds(20)), "bye\n");
}

TEST_F(ChildProcessTest, DiesWithTheProcessThatStartedIt) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    ChildProcess child(shell("exec sleep 60"));
    const pid_t grandchild = child.id();
    if (write(ends[1], &grandchild, sizeof grandchild) < 0) _exit(1);
    raise(SIGKILL);  // no destructor runs
  }
  pid_t grandchild = 0;
  ASSERT_EQ(read(ends[0], &grandchild, sizeof grandchild), static_cast<ssize_t>(sizeof grandchild));
  close(ends[0]);
  close(ends[1]);
  waitpid(parent, nullptr, 0);
  // Dead, if nobody collects it yet a zombie.
  const auto state = [&] {
    std::ifstream in("/proc/" + std::to_string(grandchild) + "/stat");
    std::string text;
    std::getline(in, text);
    const std::size_t name_end = text.rfind(") ");
    return name_end == std::string::npos ? 'X' : text[name_end + 2];
  };
  for (int i = 0; i < 2000 && state() != 'X' && state() != 'Z'; ++i) usleep(5000);
  EXPECT_TRUE(state() == 'X' || state() == 'Z') << state();
}

TEST_F(ChildProcessTest, AProgramThatIsNotThereIsSaid) {
  ChildProcess child({.program = folder_.file("nothing"),
                      .arguments = {"node"},
                      .log = folder_.file("log"),
                      .sandbox_member = std::nullopt});
  EXPECT_THROW(child.read_line(child_limit()), ChildError);
}

}  // namespace
}  // namespace simbench::hardware
