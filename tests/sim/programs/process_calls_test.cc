// Programs with threads and children, and generated sequences of calls beside Linux' own answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/scratch_folder.h"
#include "tests/sim/programs/calls_on_hosts.h"

namespace simbench::sim {
namespace {

using testing::Each;
using testing::ElementsAre;

class ProcessCallsTest : public CallsOnHosts {};

TEST_F(ProcessCallsTest, ThreadsDoWhatManPagesPromise) {
  EXPECT_THAT(run("thread_calls", {{"check"}}, {{"check"}}), Each(std::string("done\n")));
}

TEST_F(ProcessCallsTest, ProcessesDoWhatManPagesPromise) {
  EXPECT_THAT(run("child_calls", {{"echo"}}, {{"check", "{master}"}}),
              ElementsAre("", "done\n", "done\n"));
}

TEST_F(ProcessCallsTest, FilesAndNamedMemoryDoWhatManPagesPromise) {
  EXPECT_THAT(run("file_calls", {{}}, {{}}), Each(std::string("done\n")));
}

TEST_F(ProcessCallsTest, AProgramMayGoToTheBackground) {
  EXPECT_THAT(run("child_calls", {{"echo"}}, {{"leave"}}),
              ElementsAre("", "in the background\ndone\n", "in the background\ndone\n"));
}

TEST_F(ProcessCallsTest, ThereAreNoMoreThanTheWorldAllows) {
  EXPECT_EQ(run("thread_calls", {{"bomb"}}, {{"bomb"}})[0], "63 threads: EAGAIN\ndone\n");
  EXPECT_THAT(run("child_calls", {{"bomb"}}, {{"bomb"}}, {}, 0.02)[1],
              testing::StartsWith("fork: EAGAIN\nfork: EAGAIN\n"));
}

// Eight threads that compete for a lock: who has it next is the world's to say.
TEST_F(ProcessCallsTest, TheOrderOfThreadsRepeats) {
  const std::vector<std::string> first = run("thread_calls", {{"order"}}, {{"order"}});
  EXPECT_EQ(first[0].size(), 8 * 20 + 1 + std::string("done\n").size());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(run("thread_calls", {{"order"}}, {{"order"}}), first);
}

// What the same program prints without a world.
std::string by_linux(const std::string& words) {
  const ScratchFolder folder;
  const std::string command = "cd " + folder.path().string() + " && " + SIMBENCH_PROGRAMS +
                              "/simbench_sequences " + words + " > said.txt";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return folder.content("said.txt");
}

TEST_F(ProcessCallsTest, SequencesOfCallsEndAsUnderLinux) {
  const std::string linux_says = by_linux("1 400");
  ASSERT_GT(linux_says.size(), 400U * 400U);
  EXPECT_EQ(run("sequences", {{"1", "400", "stay"}}, {{"1", "400", "stay"}})[1], linux_says);
}

}  // namespace
}  // namespace simbench::sim
