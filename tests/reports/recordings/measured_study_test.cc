#include "reports/recordings/measured_study.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "recording/version.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"
#include "tests/reports/sample_results.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

MeasuredStudy sample_study() {
  return {.date = "2026-11-21",
          .machine = "2 cores, Linux 6.1",
          .scenario = "relay",
          .commit = "abc",
          .rows = {
              {.pipeline = "both",
               .seeds =
                   {{{.amd_ms = 0.30000000000000004,
                      .rmdv_ms = 0.15,
                      .absolute_error_ms = kNaN,
                      .host_error_ms = 0.1},
                     1},
                    {{.amd_ms = 0.5, .rmdv_ms = 0.25, .absolute_error_ms = 8, .host_error_ms = 0.2},
                     4}},
               .notes = {"repetition 2: host3 was lost"}},
              {.pipeline = "none", .seeds = {}}}};
}

class MeasuredStudyTest : public testing::Test {
 protected:
  MeasuredStudyTest() { write_measured_study(path_, sample_study()); }

  std::string content() const { return folder_.content("study.json"); }
  void write(const std::string& text) const { folder_.write("study.json", text); }
  void edit(const std::string& from, const std::string& to) const {
    std::string text = content();
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(text.replace(at, from.size(), to));
  }
  std::string problem(const std::string& scenario = "relay") const {
    try {
      read_measured_study(path_, scenario);
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  const ScratchFolder folder_;
  const std::string path_ = folder_ / "study.json";
};

TEST_F(MeasuredStudyTest, WhatIsWrittenIsRead) {
  const MeasuredStudy study = read_measured_study(path_, "relay");
  EXPECT_EQ(study.date, "2026-11-21");
  EXPECT_EQ(study.machine, "2 cores, Linux 6.1");
  EXPECT_EQ(study.commit, "abc");
  ASSERT_EQ(study.rows.size(), 2);
  EXPECT_EQ(study.rows[0].seeds[1].seed, 4);
  EXPECT_EQ(study.rows[0].seeds[0].amd_ms, 0.30000000000000004);
  EXPECT_TRUE(std::isnan(study.rows[0].seeds[0].absolute_error_ms));
  EXPECT_THAT(study.rows[0].notes, ElementsAre("repetition 2: host3 was lost"));
  EXPECT_EQ(measured_study_json(study), content());
}

TEST_F(MeasuredStudyTest, BecomesResults) {
  const evaluation::Results results = results_of(sample_study());
  EXPECT_EQ(results.scenario, "relay");
  EXPECT_EQ(results.seed_count, 2);
  EXPECT_THAT(results.rows[0].host_error_ms.values, ElementsAre(0.1, 0.2));
  EXPECT_DOUBLE_EQ(results.rows[0].rmdv_ms.median, 0.2);
  EXPECT_DOUBLE_EQ(results.rows[0].absolute_error_ms.median, 8);
  EXPECT_TRUE(std::isnan(results.rows[1].amd_ms.median));
}

TEST_F(MeasuredStudyTest, IsMadeOfTheSeedsThatWereRecorded) {
  evaluation::Results results = sample_results();
  evaluation::Row& row = results.rows[0];
  row.notes = {"repetition 1: host2 could not be reached"};
  row.seeds[0].recorded = false;
  row.seeds[1].amd_ms = 1.25;
  row.seeds[1].host_error_ms = 0.5;
  const MeasuredStudy study = measured_study(results, "today", "here");
  EXPECT_EQ(study.scenario, results.scenario);
  EXPECT_EQ(study.commit, commit());
  ASSERT_EQ(study.rows[0].seeds.size(), 1);
  EXPECT_EQ(study.rows[0].seeds[0].seed, 2);
  EXPECT_EQ(study.rows[0].seeds[0].amd_ms, 1.25);
  EXPECT_EQ(study.rows[0].seeds[0].host_error_ms, 0.5);
  EXPECT_EQ(study.rows[0].notes, row.notes);
}

TEST_F(MeasuredStudyTest, IsOfOneScenario) {
  EXPECT_THAT(problem("other"),
              AllOf(HasSubstr(path_ + ":5: /scenario: found \"relay\", allowed: 'other'")));
  EXPECT_EQ(problem(""), "nothing");
}

TEST_F(MeasuredStudyTest, SaysWhatIsWrongWhere) {
  edit("\"amd_ms\": 0.5", "\"amd_ms\": -0.5");
  EXPECT_THAT(problem(), HasSubstr("/rows/0/seeds/1/amd_ms: found -0.5, allowed: a number from 0"));
  edit("\"amd_ms\": -0.5", "\"amd_ms\": \"half\"");
  EXPECT_THAT(problem(), HasSubstr("/rows/0/seeds/1/amd_ms: found \"half\", allowed: a number"));
  edit("\"amd_ms\": \"half\"", "\"and_ms\": 1");
  EXPECT_THAT(problem(), HasSubstr("'amd_ms' is missing"));
}

TEST_F(MeasuredStudyTest, RefusesSeedsAndPipelinesThatAreThereTwice) {
  edit("\"seed\": 4", "\"seed\": 1");
  EXPECT_THAT(problem(), HasSubstr("/rows/0/seeds/1/seed: 1 is there twice"));
  edit("\"pipeline\": \"none\"", "\"pipeline\": \"both\"");
  edit("\"seed\": 1", "\"seed\": 2");
  EXPECT_THAT(problem(), HasSubstr("/rows/1/pipeline: 'both' is there twice"));
}

TEST_F(MeasuredStudyTest, RefusesANewerSchema) {
  edit("\"schema_version\": 1", "\"schema_version\": 2");
  EXPECT_THAT(problem(), HasSubstr("a newer simbench"));
}

TEST_F(MeasuredStudyTest, UnknownMembersAreIgnored) {
  edit("\"date\"", "\"weather\": \"rain\",\n \"date\"");
  EXPECT_EQ(problem(), "nothing");
}

TEST_F(MeasuredStudyTest, SaysWhenThereIsNoFile) {
  std::filesystem::remove(path_);
  EXPECT_THAT(problem(), AllOf(HasSubstr("No such file"), HasSubstr("validate-model")));
  EXPECT_THROW(write_measured_study("/nowhere/study.json", sample_study()), OutputError);
}

// Whatever is cut off or turned over, the reader refuses it or reads it: it never fails otherwise.
TEST_F(MeasuredStudyTest, SurvivesAnyDamage) {
  constexpr unsigned kSeed = 7;
  std::minstd_rand random(kSeed);
  const std::string good = content();
  for (int i = 0; i < 400; ++i) {
    std::string bad = good;
    const std::size_t at = random() % (good.size() - 2);
    if (i % 2 == 0) {
      bad.resize(at);
    } else {
      bad[at] = static_cast<char>(random() % 256);
    }
    write(bad);
    std::string found;
    EXPECT_NO_THROW(found = problem()) << "at " << at << ", seed " << kSeed;
    if (i % 2 == 1) continue;
    EXPECT_NE(found, "nothing") << "cut at " << at << ", seed " << kSeed;
  }
}

}  // namespace
}  // namespace simbench::reports
