// `simbench reconstruct` through the real program. What it computes is tested below
// tests/reconstruction/; here: its options, its messages, its folder.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kStudio = "18cam_6host_30fps_studio";

class Reconstruct : public ProgramTest {
 protected:
  // Refused with status 2 and one line that has `part`; nothing is written.
  void refuses(std::vector<std::string> arguments, const std::string& part) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    arguments.insert(arguments.begin(), "reconstruct");
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, AllOf(HasSubstr("error: "), HasSubstr(part)));
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
  }
};

TEST_F(Reconstruct, WithoutTheLibrariesItSaysHowToGetThem) {
  if (has_reconstruction()) GTEST_SKIP() << "built with the libraries";
  refuses({"--scenario", kStudio, "-o", "out"}, "tools/run --with-reconstruction");
  // Before anything else: the scenario is not even looked for.
  refuses({"--scenario", "no_such", "-o", "out"}, "libembree-dev libopen3d-dev");
}

TEST_F(Reconstruct, OptionsAreChecked) {
  refuses({}, "--scenario is required");
  refuses({"--scenario", kStudio, "--frames", "0"}, "--frames: found '0', allowed");
  refuses({"--scenario", kStudio, "--motion", "dance"}, "--motion: found 'dance', allowed: stand");
  refuses({"--scenario", kStudio, "--desync-ms", "5,-1"}, "--desync-ms: found '-1', allowed");
  refuses({"--scenario", kStudio, "--speed-factors", "1,fast"}, "found 'fast', allowed");
  refuses({"--scenario", kStudio, "--format", "markdown"}, "--format: found 'markdown'");
}

TEST_F(Reconstruct, WhatCannotBeReconstructedIsRefused) {
  if (!has_reconstruction()) GTEST_SKIP() << "built without the libraries";
  refuses({"--scenario", kStudio, "--pipelines", "no_such", "-o", "out"}, "no_such");
  refuses({"--scenario", "3cam_1host_30fps", "-o", "out"}, "studio");
  refuses({"--scenario", kStudio, "--mesh", "no_such.ply", "-o", "out"}, "no_such.ply");
  file("empty.ply", "");
  refuses({"--scenario", kStudio, "--mesh", "empty.ply", "-o", "out"}, "empty.ply");
}

TEST_F(Reconstruct, AFolderThatCannotBeWrittenIsRefusedBeforeTheWork) {
  if (!has_reconstruction()) GTEST_SKIP() << "built without the libraries";
  std::filesystem::create_directory(folder() / "mine");
  file("mine/letter.txt", "dear");
  const ProgramResult result = run({"reconstruct", "--scenario", kStudio, "-o", "mine"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("holds other files (letter.txt)"));
  EXPECT_EQ(content("mine/letter.txt"), "dear");
}

}  // namespace
}  // namespace simbench
