// Whole or not at all.
#include "reports/text/output_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "reports/text/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class OutputFileTest : public testing::Test {
 protected:
  OutputFileTest() {
    std::string pattern = (fs::temp_directory_path() / "output_file.XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~OutputFileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string content(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
  static std::string problem(const std::string& path) {
    try {
      const OutputFile file(path);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "none";
  }

 private:
  fs::path folder_;
};

TEST_F(OutputFileTest, AppearsWhole) {
  const OutputFile file(path("a.html"));
  file.write("<p>");
  EXPECT_FALSE(fs::exists(path("a.html")));
  file.publish();
  EXPECT_EQ(content(path("a.html")), "<p>");
  EXPECT_EQ(files(), 1);
}

TEST_F(OutputFileTest, NothingIsLeftOfWhatWasNotWritten) {
  { const OutputFile file(path("a.html")); }
  EXPECT_EQ(files(), 0);
}

TEST_F(OutputFileTest, AnEarlierFileStaysUntilThenAndIsReplaced) {
  std::ofstream(path("a.html")) << "earlier";
  {
    const OutputFile file(path("a.html"));
    EXPECT_EQ(content(path("a.html")), "earlier");
  }
  EXPECT_EQ(content(path("a.html")), "earlier");
  write_file(path("a.html"), "later");
  EXPECT_EQ(content(path("a.html")), "later");
}

TEST_F(OutputFileTest, ALinkStaysALink) {
  std::ofstream(path("real.html")) << "earlier";
  fs::create_symlink("real.html", path("link.html"));
  write_file(path("link.html"), "later");
  EXPECT_TRUE(fs::is_symlink(path("link.html")));
  EXPECT_EQ(content(path("real.html")), "later");
}

TEST_F(OutputFileTest, WhatCannotBeWrittenIsRefusedBeforeTheWork) {
  fs::create_directory(path("folder"));
  EXPECT_THAT(problem(path("folder")), HasSubstr("is a folder; name a file"));
  EXPECT_THAT(problem(path("missing/a.html")), HasSubstr("missing; make it first"));
  EXPECT_THAT(problem("/dev/null"), HasSubstr("is no file that can be replaced"));
  EXPECT_THAT(problem("/proc/a.html"), HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace simbench::reports
