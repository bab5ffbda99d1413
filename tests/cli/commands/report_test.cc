// `simbench report`: one file from archives, and clear words where it cannot be made. How the page
// looks and behaves is tested in a browser (tests/browser/).
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Report : public ProgramTest {
 protected:
  void make_archive(const std::string& name, const std::string& first_seed = "1") const {
    const ProgramResult result = run({"run", "--scenario", "18cam_6host_45fps", "--seeds", "3",
                                      "--first-seed", first_seed, "--set", "/timeline/frames=60",
                                      "--pipelines", "yoon2021_both,oracle", "--output", name});
    ASSERT_EQ(result.status, 0) << result.err;
  }

  ProgramResult report(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"report", "-o", "report.html", "--budget-seeds", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  bool has(const std::string& part) const {
    return content("report.html").find(part) != std::string::npos;
  }

  void expect_refused(const ProgramResult& result, const std::string& why) const {
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr(why));
    EXPECT_THAT(names_in(), Not(testing::Contains(HasSubstr("report.html"))));
  }

  // Changes a member of one of the archive's files.
  void edit(const std::string& name, const std::string& pointer, const Json& value) const {
    Json root = Json::parse(content(name));
    root[Json::json_pointer(pointer)] = value;
    file(name, root.dump(2));
  }
};

TEST_F(Report, IsOneFileWithTablesAndFigures) {
  make_archive("monday");
  const ProgramResult result = report({"monday"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("report written to report.html"));
  EXPECT_THAT(names_in(), ElementsAre("monday", "report.html"));
  for (const char* part : {"<!doctype html>", "yoon2021_both", "(changed)", "\"frame_errors\"",
                           "\"digital_clocks\"", "\"host_clocks\"", "\"u24\""}) {
    EXPECT_TRUE(has(part)) << part;
  }
  EXPECT_FALSE(has("--seeds-in-detail)"));  // nothing was left out
}

TEST_F(Report, EqualArchivesGiveEqualBytes) {
  make_archive("monday");
  ASSERT_EQ(report({"monday"}).status, 0);
  const std::string first = content("report.html");
  ASSERT_EQ(report({"monday"}).status, 0);
  EXPECT_TRUE(first == content("report.html"));
}

TEST_F(Report, SeedsAndPipelinesInDetailAreChosenAndSaid) {
  make_archive("monday");
  const ProgramResult result =
      report({"monday", "--seeds-in-detail", "1", "--pipelines", "yoon2021_both"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(has("are shown for the first 1 (--seeds-in-detail). In detail: 1 of 2 pipelines"));
  EXPECT_FALSE(has("\"pipeline\":\"oracle\",\"seed\":\"1\""));
  EXPECT_TRUE(has("\"pipeline\":\"yoon2021_both\",\"seed\":\"1\""));
  EXPECT_FALSE(has("\"pipeline\":\"yoon2021_both\",\"seed\":\"2\""));
}

TEST_F(Report, ErrorBudgetsAreDrawnIfAskedFor) {
  make_archive("monday");
  ASSERT_EQ(report({"monday"}).status, 0);
  EXPECT_FALSE(has("\"id\":\"budget\""));
  const ProgramResult result = run({"report", "monday", "-o", "report.html", "--budget-seeds", "1",
                                    "--pipelines", "yoon2021_both"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(has("\"id\":\"budget\""));
}

TEST_F(Report, SeveralArchivesShareAFile) {
  make_archive("monday");
  make_archive("tuesday", "9");
  const ProgramResult result = report({"monday", "tuesday"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(has("The archives side by side"));
  EXPECT_TRUE(has("\"seed\":\"9\""));
}

TEST_F(Report, AnArchiveNamedTwiceIsRefused) {
  make_archive("monday");
  expect_refused(report({"monday", "./monday/"}), "is named twice");
}

TEST_F(Report, AResultAloneHasTablesAndDistributionsOnly) {
  make_archive("monday");
  file("alone.json", content("monday/results.json"));
  const ProgramResult result = report({"alone.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning: alone.json has no manifest"));
  EXPECT_TRUE(has("\"id\":\"distributions\""));
  EXPECT_FALSE(has("\"id\":\"stamps\""));
  EXPECT_TRUE(has("has no manifest, which names the scenario"));
}

TEST_F(Report, DamagedArchivesAreRefused) {
  make_archive("monday");
  expect_refused(report({"tuesday"}), "tuesday");
  const std::string results = content("monday/results.json");
  file("monday/results.json", results.substr(0, results.size() / 2));
  expect_refused(report({"monday"}), "monday/results.json:");
  file("monday/results.json", results);
  file("monday/frames.csv", "pipeline,seed\n");
  expect_refused(report({"monday"}), "monday/frames.csv");
}

TEST_F(Report, AnotherVersionIsSaidAndItsOtherRunsAreLeftOut) {
  make_archive("monday");
  edit("monday/manifest.json", "/commit", "0123456789ab");
  edit("monday/results.json", "/commit", "0123456789ab");
  ASSERT_EQ(report({"monday"}).status, 0);
  EXPECT_TRUE(has("The results are of simbench 0.1.0 (0123456789ab)"));
  edit("monday/results.json", "/rows/0/amd_ms/values/0", 123.5);
  const ProgramResult result = report({"monday"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("yoon2021_both, seed 1: the archive's AMD is 123.5 ms"));
  EXPECT_FALSE(has("\"pipeline\":\"yoon2021_both\",\"seed\":\"1\""));
  EXPECT_TRUE(has("\"pipeline\":\"yoon2021_both\",\"seed\":\"2\""));
}

TEST_F(Report, AScenarioThatIsNotTakenLeavesWhatTheArchiveHolds) {
  make_archive("monday");
  edit("monday/manifest.json", "/scenario/cameras/gravity", 9.81);
  const ProgramResult result = report({"monday"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning: The runs cannot be repeated"));
  EXPECT_TRUE(has("\"id\":\"frame_errors\""));
  EXPECT_FALSE(has("\"id\":\"stamps\""));
}

TEST_F(Report, WrongWordsAreRefused) {
  make_archive("monday");
  expect_refused(report({"monday", "--pipelines", "yoon2021_bth"}),
                 "--pipelines: found 'yoon2021_bth', allowed for monday: yoon2021_both, oracle");
  expect_refused(run({"report", "monday", "monday/results.json"}),
                 "--output: found none for 2 archives");
  expect_refused(run({"report", "-o", "report.html"}), "archives");
  expect_refused(run({"report", "monday", "-o", "missing/report.html"}), "missing; make it first");
  expect_refused(run({"report", "monday", "-o", "monday"}),
                 "monday is one of the inputs, allowed: another file");
}

TEST_F(Report, LiesBesideItsArchiveUnlessNamed) {
  std::filesystem::create_directory(folder() / "results");
  make_archive("results/monday");
  const ProgramResult result = run({"report", "results/monday/", "--budget-seeds", "0"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("report written to results/monday.html"));
  EXPECT_THAT(names_in("results"), ElementsAre("monday", "monday.html"));
}

TEST_F(Report, AFullDiskLeavesTheEarlierReport) {
  make_archive("monday");
  file("report.html", "earlier");
  const ProgramResult result = run({"report", "monday", "-o", "report.html", "--budget-seeds", "0"},
                                   {.largest_file = std::size_t{8192}});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("nothing was kept"));
  EXPECT_EQ(content("report.html"), "earlier");
  EXPECT_THAT(names_in(), ElementsAre("monday", "report.html"));
}

TEST_F(Report, CtrlCLeavesNothing) {
  const ProgramResult made = run({"run", "--scenario", "18cam_6host_45fps", "--seeds", "20",
                                  "--pipelines", "yoon2021_both,oracle", "--output", "monday"});
  ASSERT_EQ(made.status, 0) << made.err;
  // The budgets of 20 seeds take seconds.
  const ProgramResult result =
      run({"report", "monday", "-o", "report.html", "--budget-seeds", "20"},
          {.interrupt_after = std::chrono::milliseconds(400)});
  EXPECT_EQ(result.status, 130);
  EXPECT_THAT(result.err, HasSubstr("interrupted after"));
  EXPECT_THAT(names_in(), ElementsAre("monday"));
}

}  // namespace
}  // namespace simbench
