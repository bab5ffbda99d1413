// `simbench reconstruct` to its end, where it was built with Embree and Open3D: a frame set takes
// some ten seconds.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAre;

class ReconstructSlow : public ProgramTest {
 protected:
  void SetUp() override {
    if (!has_reconstruction()) GTEST_SKIP() << "built without the libraries";
  }
  static std::vector<std::string> command(const std::string& frames) {
    return {"reconstruct", "--scenario", "18cam_6host_30fps_studio",
            "--pipelines", "oracle",     "--seeds",
            "1",           "--frames",   frames,
            "--no-curve",  "--format",   "json",
            "-o",          "out"};
  }
};

TEST_F(ReconstructSlow, WritesTheFolder) {
  const ProgramResult result = run(command("1"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(names_in("out"),
              UnorderedElementsAre("manifest.json", "scenario.json", "table.txt", "results.json",
                                   "report.html", "oracle.ply", "oracle.png"));
  EXPECT_THAT(content("out/oracle.ply"), StartsWith("ply\n"));
  EXPECT_THAT(content("out/oracle.png"), StartsWith("\x89PNG"));
  EXPECT_EQ(content("out/results.json"), result.out);
  const Json row = Json::parse(result.out)["rows"][0];
  EXPECT_EQ(row["sets"], 1);
  EXPECT_GT(row["mean_cm"]["median"], 0.5);
  EXPECT_LT(row["mean_cm"]["median"], 5);
  EXPECT_LT(row["desync_ms"]["median"], 5);  // one pulse of the trigger
  EXPECT_EQ(run({"validate", "out/scenario.json"}).status, 0);
}

TEST_F(ReconstructSlow, AnInterruptLeavesNothing) {
  const ProgramResult result =
      run(command("100"), {.interrupt_after = std::chrono::milliseconds(3000)});
  EXPECT_EQ(result.status, 130);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("no result was written"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

}  // namespace
}  // namespace simbench
