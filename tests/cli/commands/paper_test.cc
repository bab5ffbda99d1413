// `simbench paper` through the real program. What its numbers say is tested with hand-made results
// (tests/reports/paper/) and claims (tests/evaluation/scoring/claims_test.cc).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Paper : public ProgramTest {
 protected:
  ProgramResult paper(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"paper", "--seeds", "2", "--no-table-4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(Paper, HasEachTableAndClaimBesideWhatIsPrinted) {
  const ProgramResult result = paper({"--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto root = nlohmann::json::parse(result.out);
  // As Tables 2 and 3 are printed.
  const std::vector<std::vector<double>> amd_ms = {{547.5033, 11.1648, 15.3963, 5.8539},
                                                   {538.059, 3.9161, 4.2783, 2.438}};
  for (std::size_t rate = 0; rate < 2; ++rate) {
    std::vector<double> printed;
    for (const auto& value : nonempty(root["runs"][rate]["printed"])) {
      if (value["metric"] == "amd_ms") printed.push_back(value["printed"]);
      EXPECT_EQ(value["percentile_interval"].size(), 2U);
    }
    EXPECT_EQ(printed, amd_ms[rate]);
  }
  std::vector<std::string> ids;
  for (const auto& claim : nonempty(root["claims"])) {
    ids.push_back(claim["id"]);
    if (claim["id"] == "C4") {
      EXPECT_FALSE(claim["at_both"].is_null());
    }
    if (claim["id"] == "C12") {
      EXPECT_EQ(claim["printed"], true);
    }
  }
  EXPECT_THAT(ids, testing::IsSupersetOf({"C1", "C4", "C10", "C12", "C2 and C3"}));
  EXPECT_EQ(root["no_table_4"], "Left out (--no-table-4).");
}

TEST_F(Paper, TheSameSeedsGiveTheNumbersOfARun) {
  const auto root = nlohmann::json::parse(paper({"--format", "json"}).out);
  const auto alone = nlohmann::json::parse(
      run({"--scenario", "18cam_6host_45fps", "--seeds", "2", "--format", "json"}).out);
  EXPECT_EQ(root["runs"][1]["results"]["rows"], alone["rows"]);
}

TEST_F(Paper, WritesOnePageAndAnArchiveOfEachRate) {
  const ProgramResult result = paper({"-o", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(names_in("out"),
              ElementsAre("18cam_6host_15fps", "18cam_6host_45fps", "manifest.json", "paper.html",
                          "paper.json", "paper.txt"));
  const std::string page = content("out/paper.html");
  for (const char* part :
       {"Fig. 9", "Fig. 10", "\"fig9\"", "\"fig10\"", "\"hosts\"", "Fig. 7 a", "(6cam_2host_30fps)",
        "What is a fit", "What is not reached, and why", "Table 2: 15 fps"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_THAT(result.out, HasSubstr("2 seeds cannot place"));
  EXPECT_THAT(result.out, Not(HasSubstr("Not drawn")));
  // The archives are such as others take.
  EXPECT_EQ(run({"report", "out/18cam_6host_15fps", "-o", "r.html", "--budget-seeds", "0"}).status,
            0);
  EXPECT_EQ(run({"compare", "out/18cam_6host_45fps", "out/18cam_6host_45fps"}).status, 0);
  // An earlier result is replaced.
  EXPECT_EQ(paper({"-o", "out"}).status, 0);
}

TEST_F(Paper, WithoutAFolderItSaysHowToHaveTheFigures) {
  EXPECT_THAT(paper({}).out, HasSubstr("Not drawn: -o DIR draws them on its page."));
}

TEST_F(Paper, ReplacesNothingThatIsNotItsOwn) {
  std::filesystem::create_directory(folder() / "out");
  file("out/diary.txt", "mine");
  const ProgramResult result = paper({"-o", "out"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("holds other files (diary.txt)"));
  EXPECT_EQ(content("out/diary.txt"), "mine");
}

TEST_F(Paper, RefusesWhatItCannotRun) {
  EXPECT_THAT(run({"paper", "--seeds", "0"}).err, HasSubstr("a whole number from 1"));
  EXPECT_THAT(run({"paper", "--format", "csv"}).err, HasSubstr("table, markdown, latex, json"));
  EXPECT_EQ(run({"paper", "18cam_6host_45fps"}).status, 2);
}

}  // namespace
}  // namespace simbench
