#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "reports/text/output_file.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class OutputFolderTest : public testing::Test {
 protected:
  static std::string refusal(const fs::path& folder) {
    try {
      const OutputFolder output(folder);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "accepted";
  }

  const ScratchFolder root_;
};

TEST_F(OutputFolderTest, AppearsWhenPublished) {
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "{}";
  output.file("frames.csv") << "a,b\n";
  EXPECT_FALSE(fs::exists(root_ / "run"));
  output.publish();
  EXPECT_THAT(root_.names(), UnorderedElementsAre("run"));
  EXPECT_THAT(root_.names("run"), UnorderedElementsAre("manifest.json", "frames.csv"));
  EXPECT_EQ(root_.content("run/frames.csv"), "a,b\n");
}

TEST_F(OutputFolderTest, LeavesNothingWhenNotPublished) {
  {
    OutputFolder output(root_ / "run");
    output.file("manifest.json") << "{}";
  }
  EXPECT_THAT(root_.names(), testing::IsEmpty());
}

TEST_F(OutputFolderTest, ASlashAtTheEndMeansTheSame) {
  OutputFolder output(root_ / "run/");
  output.file("manifest.json") << "{}";
  output.publish();
  EXPECT_THAT(root_.names(), UnorderedElementsAre("run"));
}

TEST_F(OutputFolderTest, ReplacesAnEarlierResult) {
  root_.write("run/manifest.json", "old");
  root_.write("run/hosts.csv", "old");
  {
    OutputFolder unfinished(root_ / "run");
    unfinished.file("manifest.json") << "unfinished";
  }
  EXPECT_EQ(root_.content("run/manifest.json"), "old");
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "new";
  output.publish();
  EXPECT_EQ(root_.content("run/manifest.json"), "new");
  EXPECT_THAT(root_.names("run"), UnorderedElementsAre("manifest.json"));
  EXPECT_THAT(root_.names(), UnorderedElementsAre("run"));
}

TEST_F(OutputFolderTest, ReplacesAnEmptyFolder) {
  fs::create_directory(root_ / "run");
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "new";
  output.publish();
  EXPECT_EQ(root_.content("run/manifest.json"), "new");
}

TEST_F(OutputFolderTest, RefusesWhatIsNotItsOwn) {
  root_.write("mine/notes.txt", "mine");
  root_.write("mine/manifest.json", "{}");
  EXPECT_THAT(refusal(root_ / "mine"), HasSubstr("holds other files (notes.txt)"));
  root_.write("data/frames.csv", "mine");
  EXPECT_THAT(refusal(root_ / "data"), HasSubstr("nor an earlier result"));
  root_.write("file", "mine");
  EXPECT_THAT(refusal(root_ / "file"), HasSubstr("is a file"));
  EXPECT_THAT(refusal(root_ / "no/such"), HasSubstr("make it first"));
  EXPECT_THAT(refusal("/"), HasSubstr("root folder"));
  EXPECT_THAT(root_.names(), UnorderedElementsAre("mine", "data", "file"));
}

TEST_F(OutputFolderTest, RefusesWhereItMayNotWrite) {
  // proc takes no folders from anybody, root included.
  EXPECT_THAT(refusal("/proc/simbench_run"), HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace simbench::reports
