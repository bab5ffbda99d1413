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
    if (name == "frame_errors" || name == "fig8") {
      more.insert(more.end(), {"--pipelines", "yoon2021_both,oracle"});
    }
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
      {figure("fig8", "x.svg", {}), "--scenario"},
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
