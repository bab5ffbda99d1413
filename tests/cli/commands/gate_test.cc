// `simbench gate`: what CI relies on.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

class Gate : public ProgramTest {
 protected:
  // Runs two pipelines of the main scenario over few frames.
  void run_to(const std::string& output, const std::vector<std::string>& more = {},
              const std::string& pipelines = "yoon2021_both,oracle") const {
    std::vector<std::string> arguments = {
        "run",         "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=60",
        "--pipelines", pipelines,    "--output",          output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
  }
  void save(const std::string& archive) const {
    const ProgramResult result = run({"gate", archive, "--save-baseline", "b.json"});
    ASSERT_EQ(result.status, 0) << result.err;
  }
  ProgramResult gate(const std::string& archive, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"gate", archive, "--baseline", "b.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  void edit(const std::string& name, const std::string& what, const std::string& by) const {
    std::string text = content(name);
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    file(name, text.replace(at, what.size(), by));
  }
};

TEST_F(Gate, TheSameCodePasses) {
  run_to("before");
  save("before");
  run_to("now");
  const ProgramResult result = gate("now", {"--junit", "gate.xml"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("gate passed: 8 checks, 8 of them the same (exact)"));
  EXPECT_THAT(content("gate.xml"), HasSubstr("<testsuites tests=\"8\" failures=\"0\""));
  EXPECT_EQ(gate("now", {"--format", "junit"}).out, content("gate.xml"));
  EXPECT_EQ(gate("now/results.json").status, 0);
  EXPECT_THAT(names_in(), ElementsAre("b.json", "before", "gate.xml", "now"));
  EXPECT_EQ(gate("now", {"--markdown", "gate.md"}).status, 0);
  EXPECT_TRUE(content("gate.md").starts_with("## 18cam_6host_45fps: gate passed: 8 checks, "));
  EXPECT_EQ(gate("now", {"--format", "markdown"}).out, content("gate.md"));
}

// What a faster build changes: /performance, the clock times of the manifest, version and commit.
TEST_F(Gate, APureSpeedUpPasses) {
  run_to("now");
  save("now");
  Json results = Json::parse(content("now/results.json"));
  for (auto& [name, value] : results["performance"].items()) value = 10 * value.get<double>();
  results["performance"]["events"] = 7;
  results["version"] = "9.9.9";
  results["commit"] = "faster";
  file("now/results.json", results.dump());
  Json manifest = Json::parse(content("now/manifest.json"));
  manifest["finished"] = "2026-01-01T00:00:00.000Z";
  file("now/manifest.json", manifest.dump());
  const ProgramResult result = gate("now");
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("8 of them the same"));
}

TEST_F(Gate, APipelineThatVanishedFails) {
  run_to("before");
  save("before");
  run_to("now", {}, "oracle,genlock");
  const ProgramResult result = gate("now");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, HasSubstr("the pipeline yoon2021_both of the baseline is not in"));
  EXPECT_THAT(result.out, HasSubstr("so not checked: genlock"));
}

TEST_F(Gate, OtherSeedsNeedTheStatisticalMode) {
  run_to("before");
  save("before");
  run_to("now", {"--first-seed", "101"});
  const ProgramResult exact = gate("now");
  EXPECT_EQ(exact.status, 2);
  EXPECT_THAT(exact.err, HasSubstr("--mode statistical"));
  const ProgramResult statistical = gate("now", {"--mode", "statistical", "--format", "json"});
  EXPECT_EQ(statistical.status, 0) << statistical.err;
  EXPECT_EQ(Json::parse(statistical.out)["paired_by"], "index");
  run_to("few", {"--seeds", "31"});
  EXPECT_EQ(gate("few", {"--mode", "statistical"}).status, 2);
}

TEST_F(Gate, AMissingBaselineHasAStatusOfItsOwn) {
  const ProgramResult result = run({"gate", "results", "--baseline", "b.json"});
  EXPECT_EQ(result.status, 4);
  EXPECT_THAT(result.err, HasSubstr("simbench gate results --save-baseline b.json"));
}

TEST_F(Gate, AnAmdBelowZeroIsRefusedAndALostOneFailsWithoutANan) {
  run_to("now", {"--seeds", "2"});
  save("now");
  Json results = Json::parse(content("now/results.json"));
  results["rows"][1]["amd_ms"]["values"][1] = -0.5;
  file("now/results.json", results.dump(2));
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"gate", "now", "--baseline", "b.json"}, {"gate", "now", "--save-baseline", "c.json"}}) {
    const ProgramResult refused = run(command);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, testing::ContainsRegex("now/results.json:[0-9]+: "
                                                    "/rows/1/amd_ms/values/1: found -0.5, "
                                                    "allowed: a number from 0"));
  }
  for (Json& value : results["rows"][1]["amd_ms"]["values"]) value = nullptr;
  file("now/results.json", results.dump(2));
  for (const std::string format : {"text", "markdown", "json", "junit"}) {
    const ProgramResult lost = gate("now", {"--format", format});
    EXPECT_EQ(lost.status, 3);
    EXPECT_THAT(lost.out, HasSubstr("2 of 2 seeds lost"));
    EXPECT_THAT(lost.out, testing::Not(HasSubstr("nan")));
  }
}

TEST_F(Gate, BadInputIsToldApart) {
  run_to("now", {"--seeds", "2"});
  EXPECT_EQ(run({"gate", "now"}).status, 2);
  EXPECT_EQ(run({"gate", "now", "--baseline", "a", "--save-baseline", "b"}).status, 2);
  EXPECT_EQ(run({"gate", "nowhere", "--save-baseline", "b.json"}).status, 2);
  EXPECT_EQ(run({"gate", "now/results.json", "--save-baseline", "b.json"}).status, 2);
  EXPECT_EQ(run({"gate", "now", "--save-baseline", "no/such/folder/b.json"}).status, 2);
  save("now");
  const std::string whole = content("b.json");
  file("b.json", whole.substr(0, whole.size() / 2));
  const ProgramResult cut = gate("now");
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, HasSubstr("b.json:"));
  file("b.json", whole);
  edit("b.json", "\"schema_version\": 1", "\"schema_version\": 99");
  const ProgramResult newer = gate("now");
  EXPECT_EQ(newer.status, 2);
  EXPECT_THAT(newer.err, HasSubstr("/schema_version: found 99"));
  file("b.json", whole);
  EXPECT_EQ(gate("now", {"--junit", "no/such/folder/gate.xml"}).status, 2);
  EXPECT_EQ(gate("now", {"--markdown", "no/such/folder/gate.md"}).status, 2);
  run_to("other", {"--seeds", "2", "--set", "/trigger/rate_hz=30"});
  const ProgramResult other = gate("other");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("/trigger/rate_hz: 45 against 30"));
}

TEST_F(Gate, SavingAnewKeepsTheMarginsAndOnAFullDiskTheFile) {
  run_to("now", {"--seeds", "2"});
  save("now");
  edit("b.json", "\"relative\":0.02", "\"relative\":0.5");
  save("now");
  const std::string saved = content("b.json");
  EXPECT_THAT(saved, HasSubstr("\"relative\":0.5"));
  const ProgramResult full =
      run({"gate", "now", "--save-baseline", "b.json"}, {.largest_file = std::size_t{1024}});
  EXPECT_EQ(full.status, 2);
  EXPECT_EQ(content("b.json"), saved);
  EXPECT_THAT(names_in(), ElementsAre("b.json", "now"));
}

}  // namespace
}  // namespace simbench
