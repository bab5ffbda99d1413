#include "reports/text/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class OutputFolderTest : public testing::Test {
 public:
  OutputFolderTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() /
            (std::string("simbench_") + test->name() + "_" + std::to_string(getpid()));
    fs::remove_all(root_);
    fs::create_directory(root_);
  }
  ~OutputFolderTest() override { fs::remove_all(root_); }

 protected:
  static std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
      names.push_back(entry.path().filename());
    }
    return names;
  }
  static std::string content(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  static std::string refusal(const fs::path& folder) {
    try {
      const OutputFolder output(folder);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "accepted";
  }

  fs::path root_;
};

TEST_F(OutputFolderTest, AppearsWhenPublished) {
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "{}";
  output.file("frames.csv") << "a,b\n";
  EXPECT_FALSE(fs::exists(root_ / "run"));
  output.publish();
  EXPECT_THAT(names_in(root_), UnorderedElementsAre("run"));
  EXPECT_THAT(names_in(root_ / "run"), UnorderedElementsAre("manifest.json", "frames.csv"));
  EXPECT_EQ(content(root_ / "run/frames.csv"), "a,b\n");
}

TEST_F(OutputFolderTest, LeavesNothingWhenNotPublished) {
  {
    OutputFolder output(root_ / "run");
    output.file("manifest.json") << "{}";
  }
  EXPECT_THAT(names_in(root_), testing::IsEmpty());
}

TEST_F(OutputFolderTest, ASlashAtTheEndMeansTheSame) {
  OutputFolder output((root_ / "run").string() + "/");
  output.file("manifest.json") << "{}";
  output.publish();
  EXPECT_THAT(names_in(root_), UnorderedElementsAre("run"));
}

TEST_F(OutputFolderTest, ReplacesAnEarlierResult) {
  write(root_ / "run/manifest.json", "old");
  write(root_ / "run/hosts.csv", "old");
  {
    OutputFolder unfinished(root_ / "run");
    unfinished.file("manifest.json") << "unfinished";
  }
  EXPECT_EQ(content(root_ / "run/manifest.json"), "old");
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "new";
  output.publish();
  EXPECT_EQ(content(root_ / "run/manifest.json"), "new");
  EXPECT_THAT(names_in(root_ / "run"), UnorderedElementsAre("manifest.json"));
  EXPECT_THAT(names_in(root_), UnorderedElementsAre("run"));
}

TEST_F(OutputFolderTest, ReplacesAnEmptyFolder) {
  fs::create_directory(root_ / "run");
  OutputFolder output(root_ / "run");
  output.file("manifest.json") << "new";
  output.publish();
  EXPECT_EQ(content(root_ / "run/manifest.json"), "new");
}

TEST_F(OutputFolderTest, RefusesWhatIsNotItsOwn) {
  write(root_ / "mine/notes.txt", "mine");
  write(root_ / "mine/manifest.json", "{}");
  EXPECT_THAT(refusal(root_ / "mine"), HasSubstr("holds other files (notes.txt)"));
  write(root_ / "data/frames.csv", "mine");
  EXPECT_THAT(refusal(root_ / "data"), HasSubstr("no earlier result"));
  write(root_ / "file", "mine");
  EXPECT_THAT(refusal(root_ / "file"), HasSubstr("is a file"));
  EXPECT_THAT(refusal(root_ / "no/such"), HasSubstr("make it first"));
  EXPECT_THAT(refusal("/"), HasSubstr("root folder"));
  EXPECT_THAT(names_in(root_), UnorderedElementsAre("mine", "data", "file"));
}

TEST_F(OutputFolderTest, RefusesWhereItMayNotWrite) {
  // proc takes no folders from anybody, root included.
  EXPECT_THAT(refusal("/proc/simbench_run"), HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace simbench::reports
