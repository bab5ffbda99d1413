// Whole or not at all.
#include "reports/text/output_file.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OutputFileTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }
  std::string content(const std::string& name) const { return folder_.content(name); }
  std::vector<std::string> names() const { return folder_.names(); }
  std::size_t files() const { return names().size(); }
  static std::string problem(const std::string& path) {
    try {
      OutputFile file(path);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "none";
  }

 private:
  const ScratchFolder folder_;
};
using OutputFileDeathTest = OutputFileTest;

TEST_F(OutputFileTest, AppearsWhole) {
  OutputFile file(path("a.html"));
  file.write("<p>");
  EXPECT_FALSE(fs::exists(path("a.html")));
  file.publish();
  EXPECT_EQ(content("a.html"), "<p>");
  EXPECT_EQ(files(), 1U);
}

TEST_F(OutputFileTest, NoRecordingIsReplaced) {
  std::ofstream(path("a.bag")) << "#ROSBAG V2.0\n";
  fs::create_symlink("a.bag", path("link.csv"));
  EXPECT_THAT(problem(path("a.bag")), HasSubstr("a.bag: is a rosbag 2.0 bag; name another file"));
  EXPECT_THAT(problem(path("link.csv")), HasSubstr("is a rosbag 2.0 bag"));
  EXPECT_EQ(content("a.bag"), "#ROSBAG V2.0\n");
}

TEST_F(OutputFileTest, NoPartOfAFolderOfResultsIsReplaced) {
  std::ofstream(path("frames.csv")) << "camera\n";
  EXPECT_EQ(problem(path("frames.csv")), "none");
  std::ofstream(path("manifest.json")) << "{}";
  EXPECT_THAT(problem(path("frames.csv")), HasSubstr("is a part of "));
  EXPECT_EQ(problem(path("page.html")), "none");
  EXPECT_EQ(problem(path("hosts.csv")), "none");  // there is none yet
}

TEST_F(OutputFileTest, NothingIsLeftOfWhatWasNotWritten) {
  { OutputFile file(path("a.html")); }
  EXPECT_EQ(files(), 0U);
}

TEST_F(OutputFileTest, AnEarlierFileStaysUntilThenAndIsReplaced) {
  std::ofstream(path("a.html")) << "earlier";
  {
    OutputFile file(path("a.html"));
    EXPECT_EQ(content("a.html"), "earlier");
  }
  EXPECT_EQ(content("a.html"), "earlier");
  write_file(path("a.html"), "later");
  EXPECT_EQ(content("a.html"), "later");
}

TEST_F(OutputFileTest, ALinkStaysALink) {
  std::ofstream(path("real.html")) << "earlier";
  fs::create_symlink("real.html", path("link.html"));
  write_file(path("link.html"), "later");
  EXPECT_TRUE(fs::is_symlink(path("link.html")));
  EXPECT_EQ(content("real.html"), "later");
}

TEST_F(OutputFileTest, WhatCannotBeWrittenIsRefusedBeforeTheWork) {
  fs::create_directory(path("folder"));
  EXPECT_THAT(problem(path("folder")), HasSubstr("is a folder; name a file"));
  EXPECT_THAT(problem(path("missing/a.html")), HasSubstr("missing; make it first"));
  EXPECT_THAT(problem("/dev/null"), HasSubstr("is not a file that can be replaced"));
  EXPECT_THAT(problem("/proc/a.html"), HasSubstr("cannot be written"));
}

TEST_F(OutputFileTest, ALinkToNothingIsRefusedBeforeTheWork) {
  fs::create_symlink(path("nowhere"), path("link"));
  EXPECT_THAT(problem(path("link")), HasSubstr("is a link to " + path("nowhere")));
  EXPECT_EQ(files(), 1U);
}

TEST_F(OutputFileTest, WhatAKilledProcessLeftIsCleared) {
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  waitpid(dead, nullptr, 0);
  const auto unfinished = [&](pid_t process) {
    return path(".a.html." + std::to_string(process) + ".unfinished");
  };
  put(unfinished(dead), "half");
  put(unfinished(getppid()), "of a process that works");
  put(path(".a.html.txt.unfinished"), "no process");
  OutputFile file(path("a.html"));
  EXPECT_FALSE(fs::exists(unfinished(dead)));
  EXPECT_TRUE(fs::exists(unfinished(getppid())));
  EXPECT_TRUE(fs::exists(path(".a.html.txt.unfinished")));
}

// SIGINT in the midst of writing, in a program without a handler.
TEST_F(OutputFileDeathTest, AnInterruptWaitsUntilNothingIsHalfWritten) {
  const auto interrupted = [&] {
    OutputFile file(path("a.html"));
    {
      const OutputFile other(path("b.html"));
      raise(SIGINT);
    }
    file.write("whole");
    file.publish();
  };
  EXPECT_EXIT(interrupted(), testing::KilledBySignal(SIGINT), "");
  EXPECT_THAT(names(), testing::ElementsAre("a.html"));
}

}  // namespace
}  // namespace simbench::reports
