// How results of real rigs look: what they rest on, and what went wrong.
#include "reports/results/ground_truth_text.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "reports/archive/archive.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"
#include "scenarios/loader.h"
#include "tests/reports/sample_results.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using evaluation::GroundTruth;
using evaluation::Results;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string table_of(const Results& results) { return plain(results_document(results, "")); }

TEST(GroundTruthText, Labels) {
  evaluation::Row row = sample_results().rows[0];
  EXPECT_EQ(ground_truth_label(row), "simulation");
  row.ground_truth = GroundTruth::kGenlockOrder;
  EXPECT_EQ(ground_truth_label(row), "GenLock order");
  row.ground_truth = GroundTruth::kNone;
  EXPECT_EQ(ground_truth_label(row), "unverified");
  EXPECT_EQ(ground_truth_label(sample_rig_results().rows[1]), "-");
}

TEST(GroundTruthText, SimulatedResultsLookAsTheyAlwaysDid) {
  const Results results = sample_results();
  EXPECT_FALSE(has_real_rows(results));
  for (const std::string& text :
       {table_of(results), csv(results), markdown(results_document(results, "")),
        html(results_document(results, "").blocks)}) {
    EXPECT_THAT(text, AllOf(Not(HasSubstr("unverified")), Not(HasSubstr("truth,")),
                            Not(HasSubstr("GenLock order"))));
  }
}

TEST(GroundTruthText, TheTableLabelsUnverifiedRowsAndListsNotes) {
  const std::string text = table_of(sample_rig_results());
  EXPECT_THAT(text, HasSubstr("yoon2021_both  unverified  2.00 ms"));
  EXPECT_THAT(text, HasSubstr("free_running   -                 -"));
  EXPECT_THAT(text, HasSubstr("What went wrong\n"
                              "  yoon2021_both, repetition 2: camera 7 was unplugged\n"
                              "  free_running, repetition 1: host2 could not be reached\n"));
  EXPECT_THAT(text, HasSubstr("looks perfect"));
  EXPECT_THAT(text, HasSubstr("Every repetition of a pipeline is a capture of its own."));
  EXPECT_THAT(text, Not(HasSubstr("events/s")));
  EXPECT_THAT(markdown(results_document(sample_rig_results(), "")),
              HasSubstr("| yoon2021_both | unverified | 2.00 ms |"));
}

// Without line breaks and what stands before the next line.
std::string in_one_line(const std::string& text) {
  return std::regex_replace(text, std::regex("\\s+"), " ");
}

// Every form and table says it, if and only if the scenario draws loads.
TEST(GroundTruthText, LoadsOfPipelinesAreNotOfOneWorld) {
  for (const bool draws : {true, false}) {
    Results results = sample_results();
    results.draws_load = draws;
    const Document all = results_document(results, "");
    const Document board = leaderboard_document(results, "");
    const Document summary = summary_document(results, {}, {});
    for (const std::string& text : {plain(all), markdown(all), latex(all), html(all.blocks),
                                    plain(board), plain(summary), html(summary.blocks)}) {
      const std::string line = in_one_line(text);
      EXPECT_THAT(line, HasSubstr("Every pipeline meets the same worlds, one per seed"));
      EXPECT_EQ(line.find("is drawn for each pipeline on its own") != std::string::npos, draws)
          << text;
    }
    EXPECT_EQ(nlohmann::json::parse(json(results)).contains("own_load_of_pipelines"), draws);
  }
}

TEST(GroundTruthText, GenlockCapturesAreVerified) {
  const std::string text = table_of(sample_genlock_results());
  EXPECT_THAT(text, HasSubstr("GenLock order"));
  EXPECT_THAT(text, Not(HasSubstr("unverified")));
}

TEST(GroundTruthText, IndexErrorsOfUnverifiedSetsAreNotKnown) {
  Results results = sample_rig_results();
  results.rows[1].gathering = "epsilon";  // so that the sets are shown
  EXPECT_THAT(table_of(results),
              HasSubstr("yoon2021_both  yoon2021        720          -       -       -        4"));
}

TEST(GroundTruthText, CsvHasThreeMoreColumns) {
  const std::string text = csv(sample_rig_results());
  EXPECT_THAT(text, HasSubstr(",scored_seeds,standing,failed,ground_truth,verified,notes\n"));
  EXPECT_THAT(text, HasSubstr(",none,unverified,repetition 2: camera 7 was unplugged\n"));
  EXPECT_THAT(text, HasSubstr("; repetition 2: host2 is \"\"lost\"\", too\"\n"));
  EXPECT_THAT(text, HasSubstr(",720,,,,4,,21,"));  // neither pure sets nor index errors
  EXPECT_THAT(csv(sample_genlock_results()), HasSubstr(",genlock_order,verified,\n"));
}

TEST(GroundTruthText, HtmlAndLeaderboardLabelThemToo) {
  EXPECT_THAT(html(results_document(sample_rig_results(), "").blocks),
              AllOf(HasSubstr("unverified"), HasSubstr("camera 7 was unplugged")));
  EXPECT_THAT(plain(leaderboard_document(sample_rig_results(), "")),
              AllOf(HasSubstr("yoon2021_both (unverified)"), HasSubstr("host2 is \"lost\"")));
}

TEST(GroundTruthText, JsonSaysItOfEachRow) {
  const auto simulated = nlohmann::json::parse(json(sample_results()));
  EXPECT_EQ(simulated["rows"][0]["ground_truth"], "simulation");
  EXPECT_EQ(simulated["rows"][0]["verified"], true);
  EXPECT_EQ(simulated["rows"][0]["notes"], nlohmann::json::array());
  const auto row = nlohmann::json::parse(json(sample_rig_results()))["rows"][0];
  EXPECT_EQ(row["ground_truth"], "none");
  EXPECT_EQ(row["verified"], false);
  EXPECT_EQ(row["notes"][0], "repetition 2: camera 7 was unplugged");
  for (const char* name :
       {"precision", "recall", "margin_ms", "pure_sets", "complete_pulses", "index_errors"}) {
    EXPECT_TRUE(row["gathering_score"][name].is_null()) << name;
  }
  EXPECT_TRUE(row["absolute_error_ms"]["median"].is_null());
}

class GroundTruthArchive : public testing::Test {
 protected:
  Results read(const nlohmann::ordered_json& root) const {
    return read_archive(folder_.write("results.json", root.dump(2))).results;
  }
  ScratchFolder folder_;
};

TEST_F(GroundTruthArchive, ReadsWhatItWrites) {
  const Results results = sample_rig_results();
  const Results read_back = read(nlohmann::ordered_json::parse(json(results)));
  EXPECT_EQ(read_back.rows[0].ground_truth, GroundTruth::kNone);
  EXPECT_EQ(read_back.rows[0].sets.pure, 0);
  EXPECT_THAT(read_back.rows[0].notes, ElementsAre("repetition 2: camera 7 was unplugged"));
  EXPECT_EQ(
      read(nlohmann::ordered_json::parse(json(sample_genlock_results()))).rows[1].ground_truth,
      GroundTruth::kGenlockOrder);
}

TEST_F(GroundTruthArchive, OlderArchivesAreOfSimulations) {
  auto root = nlohmann::ordered_json::parse(json(sample_results()));
  for (auto& row : root["rows"]) {
    for (const char* name : {"ground_truth", "verified", "notes"}) row.erase(name);
  }
  const Results read_back = read(root);
  EXPECT_EQ(read_back.rows[0].ground_truth, GroundTruth::kSimulation);
  EXPECT_TRUE(read_back.rows[0].verified());
}

TEST_F(GroundTruthArchive, RefusesATruthThatIsNone) {
  auto root = nlohmann::ordered_json::parse(json(sample_results()));
  root["rows"][0]["ground_truth"] = "guess";
  try {
    read(root);
    FAIL() << "nothing was thrown";
  } catch (const scenarios::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/rows/0/ground_truth: found \"guess\", allowed: "
                                              "\"simulation\", \"genlock_order\" or \"none\"")));
  }
}

}  // namespace
}  // namespace simbench::reports
