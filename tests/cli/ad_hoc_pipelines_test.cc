// Pipelines stated by their algorithms, wherever pipelines are chosen.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kStated = "two_way_hull+hull_switch_10s+yoon2021";

class AdHocPipelines : public ProgramTest {
 protected:
  // On a small world, which the arguments need not name.
  ProgramResult small(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {command, "--scenario", "3cam_1host_30fps", "--set",
                                          "/timeline/frames=20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  std::string refusal(const std::string& pipelines) const {
    const ProgramResult result = small("run", {"--seeds", "1", "--pipelines", pipelines});
    EXPECT_EQ(result.status, 2) << pipelines;
    EXPECT_EQ(result.out, "");
    return result.err;
  }
};

TEST_F(AdHocPipelines, AreRowsNamedByTheirText) {
  const ProgramResult result = small("run", {"--seeds", "2", "--format", "json", "-o", "results",
                                             "--pipelines", std::string("oracle,") + kStated});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json rows = Json::parse(result.out)["rows"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["pipeline"], "oracle");
  EXPECT_EQ(rows[1]["pipeline"], kStated);
  EXPECT_EQ(rows[1]["host_sync"], "two_way_hull");
  EXPECT_EQ(rows[1]["device_time"], "hull_switch_10s");
  EXPECT_EQ(rows[1]["gathering"], "yoon2021");
  const Json scenario = Json::parse(content("results/manifest.json"))["scenario"];
  EXPECT_EQ(scenario["pipelines"].back()["name"], kStated);
}

TEST_F(AdHocPipelines, GiveTheNumbersOfTheSamePipelineByName) {
  const ProgramResult named =
      run({"3cam_1host_30fps", "--seeds", "2", "--format", "json", "--pipelines", "oracle"});
  const Json row = Json::parse(named.out)["rows"][0];
  const std::string text = row["host_sync"].get<std::string>() + "+" +
                           row["device_time"].get<std::string>() + "+" +
                           row["gathering"].get<std::string>();
  const ProgramResult stated =
      run({"3cam_1host_30fps", "--seeds", "2", "--format", "json", "--pipelines", text});
  ASSERT_EQ(stated.status, 0) << stated.err;
  EXPECT_EQ(Json::parse(stated.out)["rows"][0]["absolute_error_ms"], row["absolute_error_ms"]);
}

TEST_F(AdHocPipelines, ArchivesOfThemAreReadAgain) {
  ASSERT_EQ(small("run", {"--seeds", "2", "-o", "results", "--pipelines",
                          std::string(kStated) + ",oracle"})
                .status,
            0);
  const ProgramResult report = run({"report", "results", "--budget-seeds", "0"});
  ASSERT_EQ(report.status, 0) << report.err;
  EXPECT_THAT(report.err, HasSubstr("report written to results.html"));
  EXPECT_THAT(content("results.html"), HasSubstr(kStated));
  EXPECT_EQ(run({"figure", "gathering", "results", "--pipelines", kStated, "-o", "g.csv"}).status,
            0);
  const ProgramResult compared =
      run({"compare", "results", "--with-baseline", "oracle", "--format", "latex"});
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("\\begin{tabular}"));
  ASSERT_EQ(run({"gate", "results", "--save-baseline", "base.json"}).status, 0);
  EXPECT_EQ(run({"gate", "results", "--baseline", "base.json"}).status, 0);
}

TEST_F(AdHocPipelines, GoWherePipelinesGo) {
  const ProgramResult budget =
      small("run", {"--seeds", "1", "--budget", "--pipelines", "oracle+raw_arrival+genlock"});
  EXPECT_EQ(budget.status, 0) << budget.err;
  EXPECT_THAT(budget.out, HasSubstr("oracle+raw_arrival+genlock"));
  const ProgramResult trace =
      small("trace", {"--pipeline", kStated, "--format", "csv", "-o", "trace.csv"});
  EXPECT_EQ(trace.status, 0) << trace.err;
  const ProgramResult record = small("record", {"--pipelines", kStated, "-o", "recorded"});
  ASSERT_EQ(record.status, 0) << record.err;
  EXPECT_THAT(run({"replay", "recorded"}).out, HasSubstr(kStated));
  const ProgramResult figure =
      small("figure", {"gathering", "--pipelines", kStated, "-o", "gathering.csv"});
  EXPECT_EQ(figure.status, 0) << figure.err;
  const ProgramResult sweep = small("sweep", {"--sweep", "/trigger/rate_hz=15,30", "--seeds", "1",
                                              "--pipelines", kStated, "-o", "swept"});
  ASSERT_EQ(sweep.status, 0) << sweep.err;
  EXPECT_THAT(content("swept/sweep.csv"), HasSubstr(std::string("15,") + kStated + ",1,"));
}

TEST_F(AdHocPipelines, ClocksNeedAHostSyncOnly) {
  const ProgramResult result =
      run({"clocks", "--scenario", "6host_star", "--pipelines", "two_way_hull", "--seeds", "1",
           "--duration-s", "400", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(Json::parse(result.out)["rows"][0]["pipeline"], "two_way_hull");
  EXPECT_THAT(run({"clocks", "--scenario", "6host_star", "--pipelines", "free_running", "--seeds",
                   "1", "--duration-s", "400", "--format", "tidy"})
                  .out,
              HasSubstr("\n6host_star,free_running,1,clock_spread_ms,ms,"));
  const ProgramResult unknown = run({"clocks", "--scenario", "6host_star", "--pipelines", "crony"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean chrony?"));
}

TEST_F(AdHocPipelines, WrongOnesAreRefused) {
  EXPECT_THAT(refusal("two_way_hul+hull_300+yoon2021"),
              AllOf(StartsWith("error: --pipelines two_way_hul+hull_300+yoon2021: "),
                    HasSubstr("found \"two_way_hul\", did you mean two_way_hull?")));
  EXPECT_THAT(refusal("two_way_hull+hull_30+yoon2021"), HasSubstr("did you mean hull_300?"));
  EXPECT_THAT(refusal("two_way_hull+hull_300+genlok"), HasSubstr("did you mean genlock?"));
  EXPECT_THAT(refusal("two_way_hull+hull_300"),
              HasSubstr("found 2 parts, allowed: host_sync or "
                        "host_sync[+capture_alignment]+device_time+gathering"));
  EXPECT_THAT(refusal("a+b+c+d+e"), HasSubstr("found 5 parts"));
  EXPECT_THAT(refusal("two_way_hull+phase_rat+hull_300+yoon2021"),
              HasSubstr("found \"phase_rat\", did you mean phase_rate?"));
  EXPECT_THAT(refusal("two_way_hull++yoon2021"), HasSubstr("found an empty part"));
  EXPECT_THAT(refusal("+hull_300+yoon2021"), HasSubstr("found an empty part"));
  EXPECT_THAT(refusal(std::string(kStated) + "," + kStated), HasSubstr("is named twice"));
  EXPECT_THAT(refusal("oracle+hull_300+\x1b[2Jyoon2021"), HasSubstr("\\u001b[2J"));
}

}  // namespace
}  // namespace simbench
