// How a program's end is told. Its requests are served by hand.
#include "processes/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/scratch_folder.h"

namespace simbench::processes {
namespace {

using testing::EndsWith;
using testing::StartsWith;

class ChildTest : public testing::Test {
 protected:
  // Grants every request, with the monotonic clock at an hour.
  ProgramEnd end_of(std::vector<std::string> words, const std::string& reason = "") const {
    words.front() = std::string(SIMBENCH_PROGRAMS) + "/simbench_" + words.front();
    Child child({.command = words,
                 .folder = folder_.path().string(),
                 .log_name = "program.log",
                 .shim = SIMBENCH_SHIM});
    while (const std::optional<ChildRequest> request = child.next()) {
      if (!reason.empty()) break;
      const shim::Identity identity{.process = 100, .address = 0};
      child.reply(3600 * std::int64_t{1'000'000'000}, 0, std::as_bytes(std::span(&identity, 1)));
    }
    return child.end_of(reason);
  }

  const ScratchFolder folder_;
};

TEST_F(ChildTest, AnExitStatusIsAValue) {
  const ProgramEnd end = end_of({"calls", "exit"});
  EXPECT_EQ(end.program, "simbench_calls");
  EXPECT_EQ(end.how, "exited with status 3");
  EXPECT_EQ(end.status, 3);
  EXPECT_EQ(end.text(), "simbench_calls: exited with status 3: what it says last");
}

TEST_F(ChildTest, WhatWasEndedHasNone) {
  const ProgramEnd end = end_of({"endings", "wait"}, "asks too much");
  EXPECT_EQ(end.how, "asks too much");
  EXPECT_EQ(end.status, std::nullopt);
  const ProgramEnd absent = end_of({"not_there"});
  EXPECT_EQ(absent.how, "cannot be run");
}

// Its output may be long, in colours and no text at all.
TEST_F(ChildTest, LastWordsAreOnePrintableLine) {
  const ProgramEnd end = end_of({"endings", "tidy"});
  EXPECT_EQ(end.status, 5);
  EXPECT_THAT(end.last_words, StartsWith("last \\x1b[31mred\\x07 \\xff xxx"));
  EXPECT_THAT(end.last_words, EndsWith("xxx [...]"));
  EXPECT_LT(end.last_words.size(), 400U);
}

}  // namespace
}  // namespace simbench::processes
