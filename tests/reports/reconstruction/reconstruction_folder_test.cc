#include "reports/reconstruction/reconstruction_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/reports/sample_reconstruction.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Pair;

scenarios::Scenario scenario_with(const std::vector<std::string>& pipelines) {
  scenarios::Scenario scenario;
  for (const std::string& name : pipelines) {
    scenario.pipelines.push_back(
        {.name = name, .host_sync = "", .device_time = "", .gathering = ""});
  }
  return scenario;
}

class ReconstructionFolderTest : public testing::Test {
 protected:
  std::string write() const {
    auto results = sample_reconstruction();
    results.scenario.resolved_json = scenarios::Lazy<std::string>(R"({"name": "a_studio"})");
    ReconstructionFolder folder(path(), scenario_with({"ntp_last_set", "yoon2021_both", "oracle"}));
    reconstruction::ShownMesh mesh;
    mesh.pipeline = "oracle";
    mesh.ply = "ply\n";
    mesh.png = {0x89, 'P'};
    folder.keep(mesh);
    return folder.write(results,
                        {.command = {"simbench", "reconstruct"}, .started = {}, .finished = {}});
  }
  std::string path() const { return root_ / "out"; }
  std::string content(const std::string& name) const { return root_.content("out/" + name); }

  const ScratchFolder root_;
};

TEST_F(ReconstructionFolderTest, HoldsEverythingAndIsReplacedAsAWhole) {
  for (int i = 0; i < 2; ++i) {  // the second time over the first
    const std::string not_drawn = write();
    EXPECT_THAT(root_.names(), ElementsAre("out"));
    EXPECT_THAT(root_.names("out"),
                IsSupersetOf({"manifest.json", "scenario.json", "table.txt", "results.json",
                              "oracle.ply", "oracle.png", "curve.csv", "report.html"}));
    EXPECT_NE(fs::exists(root_ / "out/curve.svg"), !not_drawn.empty());
  }
  EXPECT_EQ(content("oracle.ply"), "ply\n");
  EXPECT_EQ(content("oracle.png"), "\x89P");
  EXPECT_EQ(content("scenario.json"), "{\"name\": \"a_studio\"}");
  EXPECT_THAT(content("table.txt"), HasSubstr("How good must my synchronisation be"));
  EXPECT_THAT(content("curve.csv"), HasSubstr("1.20 m/s,100,2.9"));
  EXPECT_THAT(content("report.html"), HasSubstr("data:image/png;base64,iVA="));
  EXPECT_EQ(nlohmann::json::parse(content("manifest.json"))["kind"], "reconstruction");
}

TEST_F(ReconstructionFolderTest, LeavesNothingWithoutResults) {
  {
    ReconstructionFolder folder(path(), scenario_with({"a"}));
    reconstruction::ShownMesh mesh;
    mesh.pipeline = "a";
    mesh.ply = "ply\n";
    folder.keep(mesh);
  }
  EXPECT_THAT(root_.names(), ElementsAre());
}

TEST_F(ReconstructionFolderTest, AFolderWithOtherFilesIsRefused) {
  fs::create_directory(path());
  std::ofstream(path() + "/holiday.png") << "mine";
  std::ofstream(path() + "/manifest.json") << "{}";
  try {
    const ReconstructionFolder folder(path(), scenario_with({"a"}));
    ADD_FAILURE() << "accepted";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("holds other files (holiday.png)"));
  }
  EXPECT_EQ(content("holiday.png"), "mine");
}

TEST(MeshNames, StayInTheFolderAndApart) {
  EXPECT_THAT(mesh_names(scenario_with({"yoon2021_both", "../a", "a b", "a/b", ".."})),
              ElementsAre(Pair("..", "_."), Pair("../a", "_._a"), Pair("a b", "a_b"),
                          Pair("a/b", "a_b_2"), Pair("yoon2021_both", "yoon2021_both")));
}

}  // namespace
}  // namespace simbench::reports
