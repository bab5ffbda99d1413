#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

const std::vector<std::string> kOfScenario = {"--scenario", "18cam_6host_45fps", "--set",
                                              "/timeline/frames=40"};

class FigureTest : public ProgramTest {
 protected:
  ProgramResult figure(const std::string& name, const std::string& output,
                       const std::vector<std::string>& more = kOfScenario) const {
    std::vector<std::string> arguments = {"figure", name, "-o", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(FigureTest, TakesTheOptionsAndFilesOfOtherCommandsForRecordings) {
  std::string stamps = "#timestamp [ns]\n";
  for (int i = 0; i < 400; ++i) stamps += std::to_string(i * 50'000'000L) + "\n";
  file("cam0.csv", stamps);
  file("cam1.csv", stamps);
  const ProgramResult result = figure("phases", "p.csv",
                                      {"cam0.csv", "cam1.csv", "--columns",
                                       "sensor=#timestamp [ns]:ns,arrival=#timestamp [ns]:ns"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(content("p.csv"), HasSubstr("frame: how the phase moves,cam0,"));
  EXPECT_THAT(content("p.csv"), HasSubstr("frame: how the phase moves,cam1,"));
}

TEST_F(FigureTest, ListsThem) {
  const ProgramResult result = run({"figure", "--list"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("digital_clocks"));
  EXPECT_THAT(result.out, HasSubstr("Fig. 9, 10"));
}

TEST_F(FigureTest, WritesSvgPdfAndCsv) {
  EXPECT_EQ(figure("fig8", "x.svg").status, 0);
  EXPECT_THAT(content("x.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(figure("fig2", "x.pdf").status, 0);
  EXPECT_THAT(content("x.pdf"), StartsWith("%PDF"));
  const ProgramResult csv = figure("fig12", "x.csv");
  EXPECT_EQ(csv.status, 0);
  EXPECT_THAT(csv.out, IsEmpty());
  EXPECT_THAT(csv.err, HasSubstr("8.3 ms"));
  EXPECT_THAT(content("x.csv"),
              StartsWith("panel,series,x,y,changed\ngenlock,\"host 0, camera 0\",00:"));
  EXPECT_THAT(names_in(), ElementsAre("x.csv", "x.pdf", "x.svg"));
}

TEST_F(FigureTest, AFigureOfThePaperIsByItselfOfItsWorldAndPipeline) {
  const ProgramResult by_itself = figure("fig5", "a.csv", {});
  ASSERT_EQ(by_itself.status, 0) << by_itself.err;
  EXPECT_THAT(by_itself.err, HasSubstr("6cam_2host_30fps, ntp_last_set, 1 seed (1)"));
  EXPECT_EQ(
      figure("hosts", "b.csv", {"--scenario", "6cam_2host_30fps", "--pipelines", "ntp_last_set"})
          .status,
      0);
  EXPECT_EQ(content("a.csv"), content("b.csv"));
  const ProgramResult errors = figure("fig9", "c.csv", {});
  ASSERT_EQ(errors.status, 0) << errors.err;
  EXPECT_THAT(errors.err, HasSubstr("18cam_6host_15fps"));
}

TEST_F(FigureTest, ANumberOfThePaperIsNotDrawnOfAnotherRate) {
  ASSERT_EQ(run({"run", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=40",
                 "--pipelines", "oracle", "--seeds", "1", "--output", "results"})
                .status,
            0);
  const ProgramResult refused = figure("fig9", "x.csv", {"results"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("fig10 is the paper's at this rate, frame_errors draws any"));
  const ProgramResult right = figure("fig10", "x.csv", {"results"});
  EXPECT_EQ(right.status, 0) << right.err;
  EXPECT_THAT(right.err, HasSubstr("The paper's figure also has ntp_last_set, yoon2021_network"));
}

TEST_F(FigureTest, WhatARecordingLacksIsNamedWithTheCommandThatRecordsIt) {
  ASSERT_EQ(run({"record", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=40",
                 "--pipelines", "yoon2021_both", "-o", "rig"})
                .status,
            0);
  const ProgramResult colour = figure("fig11", "x.csv", {"rig"});
  EXPECT_EQ(colour.status, 2);
  EXPECT_THAT(colour.err, HasSubstr("no colour frames in rig, allowed: a recording that has them, "
                                    "as `simbench record --scenario 18cam_6host_90fps_full_slave"));
  EXPECT_EQ(figure("digital_clocks", "x.csv", {"rig"}).status, 0);
  std::string rows = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  for (int i = 0; i < 90; ++i) {
    const int at_ms = 33 * i;
    rows += "Depth,0," + std::to_string(i) + "," + std::to_string(1000 + at_ms) + "," +
            std::to_string(5000 + at_ms + i % 3) + "\n";
  }
  file("cam.csv", rows);
  const ProgramResult stamps = figure("fig2", "y.csv", {"cam.csv"});
  EXPECT_EQ(stamps.status, 2);
  EXPECT_THAT(stamps.err, HasSubstr("found no frame stamps in cam.csv, allowed: a recording that "
                                    "has them, as `simbench record --scenario"));
  EXPECT_EQ(figure("stamp_intervals", "y.csv", {"cam.csv"}).status, 0);
  for (const std::string name : {"exposures", "fig11"}) {
    const ProgramResult result = figure(name, "z.csv", {"cam.csv"});
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_THAT(result.err, HasSubstr("no true exposures")) << name;
    EXPECT_THAT(result.err, HasSubstr("simbench record --scenario")) << name;
  }
}

TEST_F(FigureTest, OneCommandPhotographsDepthAndColourInEverySyncMode) {
  const ProgramResult result = figure("fig11", "x.csv", {});
  ASSERT_EQ(result.status, 0) << result.err;
  for (const std::string row : {"genlock in genlock", "yoon2021_both in slave",
                                "yoon2021_both in full_slave", "ntp_last_set in full_slave"}) {
    for (const std::string stream : {"depth", "colour"}) {
      EXPECT_THAT(content("x.csv"), HasSubstr('"' + row + ", " + stream + '"')) << row;
    }
  }
}

TEST_F(FigureTest, OfAnArchiveIsThatOfTheScenario) {
  ASSERT_EQ(run({"run", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=40",
                 "--seeds", "2", "--output", "results"})
                .status,
            0);
  for (const std::string name : {"fig5", "frame_errors", "digital_clocks"}) {
    const ProgramResult result = figure(name, "a.csv", {"results", "--seed", "2"});
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> more = kOfScenario;
    more.insert(more.end(), {"--seed", "2"});
    EXPECT_EQ(figure(name, "b.csv", more).status, 0);
    EXPECT_EQ(content("a.csv"), content("b.csv")) << name;
  }
}

TEST_F(FigureTest, OfARecordingIsThatOfItsScenario) {
  ASSERT_EQ(run({"record", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=40",
                 "--pipelines", "yoon2021_both,oracle", "--repeats", "2", "-o", "rig"})
                .status,
            0);
  for (const std::string name : {"fig5", "frame_errors", "fig8"}) {
    const ProgramResult result = figure(name, "a.csv", {"rig", "--seed", "2"});
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> more = kOfScenario;
    more.insert(more.end(), {"--seed", "2"});
    const bool of_one = name == "fig5";
    more.insert(more.end(), {"--pipelines", of_one ? "yoon2021_both" : "yoon2021_both,oracle"});
    EXPECT_EQ(figure(name, "b.csv", more).status, 0);
    EXPECT_EQ(content("a.csv"), content("b.csv")) << name;
  }
  const ProgramResult budget = figure("budget", "c.csv", {"rig"});
  EXPECT_EQ(budget.status, 2);
  EXPECT_THAT(budget.err, HasSubstr("needs other worlds"));
  EXPECT_EQ(figure("host_clocks", "h.svg", {"rig"}).status, 0);
  const ProgramResult simulated = figure("phases", "p.svg");
  EXPECT_EQ(simulated.status, 2);
  EXPECT_THAT(simulated.err, HasSubstr("simbench record"));
}

TEST_F(FigureTest, DrawsThePhasesOfAnyRecordedRig) {
  ASSERT_EQ(run({"record", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=1500",
                 "--pipelines", "free_running", "-o", "rig"})
                .status,
            0);
  EXPECT_EQ(figure("phases", "p.csv", {"rig"}).status, 0);
  EXPECT_THAT(content("p.csv"), StartsWith("panel,series,x,y"));
  EXPECT_EQ(figure("phases", "p.svg", {"rig"}).status, 0);
  EXPECT_THAT(run({"diagnose", "rig"}).out, Not(HasSubstr("after the first camera")));
}

TEST_F(FigureTest, BadInputIsRefusedAndNothingIsWritten) {
  struct Case {
    ProgramResult result;
    std::string says;
  };
  std::vector<std::string> two = kOfScenario;
  two.insert(two.end(), {"--pipelines", "oracle,genlock"});
  const std::vector<Case> cases = {
      {figure("fig99", "x.svg"), "found 'fig99', allowed: distributions"},
      {figure("fig8", "x.png"), "ends in .svg, .pdf or .csv"},
      {figure("fig5", "x.svg", two), "allowed: one"},
      {figure("fig8", "none/x.svg"), "there is no folder none"},
      {figure("fig8", "x.svg", {"missing"}), "missing"},
      {figure("fig8", "x.svg", {"missing", "--scenario", "3cam_1host_30fps"}), "not both"},
      {figure("phases", "x.svg", {}), "simbench record"},
      {figure("fig1", "x.svg", {}), "simbench reconstruct"},
      {figure("fig6b", "x.svg", {}), "docs/reference/paper.md section 1"},
      {figure("fig7a", "x.svg", {}), "docs/reference/d455.md section 2"},
      {figure("fig9", "x.svg"),
       "found frames at 45 Hz, allowed: 15 Hz, as 18cam_6host_15fps has "
       "them; fig10 is the paper's at this rate"},
      {figure("host_clocks", "x.svg", {"--scenario", "3cam_1host_30fps"}), "There is one host"},
      {run({"figure", "fig8", "--scenario", "3cam_1host_30fps"}), "--output"}};
  for (const Case& each : cases) {
    EXPECT_EQ(each.result.status, 2) << each.says;
    EXPECT_THAT(each.result.err, HasSubstr(each.says));
  }
  EXPECT_THAT(names_in(), IsEmpty());
}

}  // namespace
}  // namespace simbench
