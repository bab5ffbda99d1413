// Whole or not at all.
#include "reports/text/output_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

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
  std::size_t files() const { return folder_.names().size(); }
  static std::string problem(const std::string& path) {
    try {
      const OutputFile file(path);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "none";
  }

 private:
  const ScratchFolder folder_;
};

TEST_F(OutputFileTest, AppearsWhole) {
  const OutputFile file(path("a.html"));
  file.write("<p>");
  EXPECT_FALSE(fs::exists(path("a.html")));
  file.publish();
  EXPECT_EQ(content("a.html"), "<p>");
  EXPECT_EQ(files(), 1U);
}

TEST_F(OutputFileTest, NothingIsLeftOfWhatWasNotWritten) {
  { const OutputFile file(path("a.html")); }
  EXPECT_EQ(files(), 0U);
}

TEST_F(OutputFileTest, AnEarlierFileStaysUntilThenAndIsReplaced) {
  std::ofstream(path("a.html")) << "earlier";
  {
    const OutputFile file(path("a.html"));
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

}  // namespace
}  // namespace simbench::reports
