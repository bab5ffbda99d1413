#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "recording/version.h"
#include "reports/archive/archive.h"
#include "reports/results/json.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/read_fault.h"
#include "tests/reports/sample_results.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ArchiveReader : public testing::Test {
 protected:
  ArchiveReader() {
    const scenarios::Scenario scenario = scenarios::load_scenario("3cam_1host_30fps");
    written_.scenario = scenario.name;
    OutputFolder output(folder_.path());
    write_archive(output, written_, scenario,
                  {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  }

  std::string path(const std::string& name) const { return folder_ / name; }
  std::string content(const std::string& name) const { return folder_.content(name); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = content(name);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(name, text.replace(at, from.size(), to));
  }
  // What reading the archive says is wrong.
  std::string problem() const {
    try {
      Archive archive = read_archive(folder_.path().string());
      read_seed_details(archive);
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  ScratchFolder folder_;
  evaluation::Results written_ = sample_results();
};

TEST_F(ArchiveReader, ChangesOfTheScenarioAreRead) {
  written_.derivation = {.base = "built_in",
                         .changes = {{"/a", "1.5", "[1,2]"}, {"/b", "", "\"c\""}},
                         .unpublished = "built_in"};
  OutputFolder output(folder_.path());
  write_archive(output, written_, scenarios::load_scenario("3cam_1host_30fps"),
                {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  const scenarios::Derivation read = read_archive(folder_.path().string()).results.derivation;
  EXPECT_EQ(read.base, "built_in");
  EXPECT_EQ(read.unpublished, "built_in");
  EXPECT_EQ(changed_text(read), "changed: /a 1.5 → [1,2], /b none → c");
  EXPECT_THAT(content("manifest.json"), HasSubstr("\"based_on\": \"built_in\""));
}

TEST_F(ArchiveReader, SeedsOfAChangedWorldAreRead) {
  written_.derivation = {.base = "built_in", .changes = {{"/a", "1", "[1,2]"}, {"/b", "", "3"}}};
  OutputFolder output(folder_.path());
  write_archive(output, written_, scenarios::load_scenario("3cam_1host_30fps"),
                {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  Archive archive = read_archive(folder_.path().string());
  read_seed_details(archive);
  ASSERT_EQ(archive.results.rows[0].seeds[1].pulses.size(), 2);
  EXPECT_EQ(archive.results.rows[0].seeds[1].pulses[1].deviation_ms, 0.5);
  EXPECT_EQ(archive.results.rows[0].seeds[1].host_errors_ms, (std::vector<double>{0, -0.125}));
  edit("hosts.csv", "0,0,1,,,,,,,\"changed", "0,0,,,,,,,\"changed");
  EXPECT_THAT(problem(), HasSubstr("hosts.csv:3: found"));
}

TEST_F(ArchiveReader, OlderNamesOfColumnsAreRead) {
  edit("frames.csv", "amd_ms,rmdv_ms", "spread_ms,deviation_ms");
  write("hosts.csv",
        "pipeline,seed,host,error_ms,synchronised\nyoon2021_both,2,0,0,1\n"
        "yoon2021_both,2,1,-0.125,1\n");
  Archive archive = read_archive(folder_.path().string());
  read_seed_details(archive);
  EXPECT_EQ(archive.results.rows[0].seeds[1].pulses[1].deviation_ms, 0.5);
  EXPECT_EQ(archive.results.rows[0].seeds[1].host_errors_ms, (std::vector<double>{0, -0.125}));
}

TEST_F(ArchiveReader, HostsWithoutDelaysOfSessionsAreRead) {
  write("hosts.csv", "pipeline,seed,host,host_error_ms,synchronised\nyoon2021_both,2,0,0.5,1\n");
  Archive archive = read_archive(folder_.path().string());
  read_seed_details(archive);
  EXPECT_EQ(archive.results.rows[0].seeds[1].host_errors_ms, (std::vector<double>{0.5}));
  EXPECT_TRUE(archive.results.rows[0].seeds[1].sessions.empty());
}

TEST_F(ArchiveReader, DelaysOfSessionsAreRead) {
  set_sessions(written_.rows[0]);
  OutputFolder output(folder_.path());
  write_archive(output, written_, scenarios::load_scenario("3cam_1host_30fps"),
                {.command = {"simbench", "run"}, .started = {}, .finished = {}});
  Archive archive = read_archive(folder_.path().string());
  EXPECT_EQ(archive.results.rows[0].t_l_ms.values, (std::vector<double>{3, 4}));
  read_seed_details(archive);
  const std::vector<SessionDelays>& read = archive.results.rows[0].seeds[1].sessions;
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].slave, 1U);
  EXPECT_EQ(read[0].pass, 2U);
  EXPECT_EQ(read[0].t_l, from_ms(3.5));
  EXPECT_EQ(read[0].set, from_ms(4.499));
  edit("hosts.csv", "3.5,2.25", "3.5e99,2.25");
  EXPECT_THAT(problem(), AllOf(HasSubstr("hosts.csv:3: found 3.5e+99 ms"), HasSubstr("allowed")));
}

TEST_F(ArchiveReader, WhatIsWrittenIsRead) {
  const Archive archive = read_archive(folder_.path().string());
  EXPECT_EQ(archive.version, version());
  EXPECT_EQ(archive.commit, commit());
  EXPECT_EQ(archive.command, (std::vector<std::string>{"simbench", "run"}));
  EXPECT_THAT(archive.scenario_json, HasSubstr("\"timeline\""));
  ASSERT_EQ(archive.results.rows.size(), 2);
  const evaluation::Row& both = archive.results.rows[0];
  EXPECT_EQ(both.amd_ms.values, (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(both.seed_recall.values, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(both.sets.complete_pulses, 960);
  EXPECT_TRUE(std::isnan(archive.results.rows[1].host_error_ms.values[1]));
}

TEST_F(ArchiveReader, WritingWhatWasReadChangesNothingButTheRecomputedBands) {
  Archive archive = read_archive(folder_.path().string());
  for (std::size_t i = 0; i < archive.results.rows.size(); ++i) {
    evaluation::Row& read = archive.results.rows[i];
    const evaluation::Row& row = written_.rows[i];
    // The sample's bands are made up; those of an archive are computed from its values.
    for (auto series :
         {&evaluation::Row::amd_ms, &evaluation::Row::rmdv_ms, &evaluation::Row::absolute_error_ms,
          &evaluation::Row::bias_ms, &evaluation::Row::host_error_ms, &evaluation::Row::max_te_ms,
          &evaluation::Row::rms_te_ms, &evaluation::Row::constant_te_ms,
          &evaluation::Row::dynamic_te_ms, &evaluation::Row::packets_per_s,
          &evaluation::Row::exposure_spread_ms, &evaluation::Row::seed_precision,
          &evaluation::Row::seed_recall, &evaluation::Row::set_amd_ms,
          &evaluation::Row::set_absolute_error_ms, &evaluation::Row::emission_latency_ms,
          &evaluation::Row::rmdv_printed_sqrt_ms, &evaluation::Row::rmdv_printed_share}) {
      (read.*series).p05 = (row.*series).p05;
      (read.*series).p95 = (row.*series).p95;
    }
  }
  EXPECT_EQ(json(archive.results), json(written_));
}

TEST_F(ArchiveReader, LoadsOfPipelinesAreRead) {
  EXPECT_FALSE(read_archive(folder_.path().string()).results.draws_load);
  written_.draws_load = true;
  write("results.json", json(written_));
  EXPECT_TRUE(read_archive(folder_.path().string()).results.draws_load);
}

TEST_F(ArchiveReader, WhatSteersTheExposuresIsRead) {
  auto root = nlohmann::ordered_json::parse(content("results.json"));
  root["rows"][1]["capture_alignment"] = "nudge";
  root["rows"][1]["wrong_locks"]["values"] = {0, 2};
  write("results.json", root.dump(2));
  const Archive archive = read_archive(folder_.path().string());
  EXPECT_EQ(archive.results.rows[0].capture_alignment, "");
  EXPECT_EQ(archive.results.rows[1].capture_alignment, "nudge");
  EXPECT_EQ(archive.results.rows[1].wrong_locks.values, (std::vector<double>{0, 2}));
}

// In archives from before the first release: they are as of a row that does not know them, and can
// be written again.
TEST_F(ArchiveReader, WithoutTheNewMetricsTheirValuesDoNotExist) {
  auto root = nlohmann::ordered_json::parse(content("results.json"));
  std::vector<const evaluation::Metric*> absent;
  for (const evaluation::Metric& metric : evaluation::metrics()) {
    if (metric.is_new && metric.is_series()) absent.push_back(&metric);
  }
  for (auto& row : root["rows"]) {
    for (const evaluation::Metric* metric : nonempty(absent)) {
      EXPECT_EQ(row.erase(metric->member()), 1U) << metric->id;
    }
    for (const char* count : {"due_pulses", "exposed_pulses"}) {
      EXPECT_EQ(row["gathering_score"].erase(count), 1U);
    }
    row.erase("standing");
    row.erase("failed");
  }
  root.erase("ranked_by");
  root.erase("loss_reasons");
  root.erase("answer");
  write("results.json", root.dump(2));
  const Archive old = read_archive(folder_.path().string());
  for (const evaluation::Row& row : nonempty(old.results.rows)) {
    for (const evaluation::Metric* metric : absent) {
      EXPECT_TRUE(std::isnan(metric->value(row))) << metric->id;
      EXPECT_THAT(metric->series(row).values,
                  testing::ElementsAre(testing::IsNan(), testing::IsNan()));
    }
  }
  write("results.json", json(old.results));
  EXPECT_EQ(problem(), "nothing");
}

TEST_F(ArchiveReader, MediansAreComputedNotRead) {
  edit("results.json", "\"median\": 2.0", "\"median\": 7.0");
  EXPECT_EQ(read_archive(folder_.path().string()).results.rows[0].amd_ms.median, 2.0);
}

TEST_F(ArchiveReader, AResultAloneHasNoManifest) {
  const Archive archive = read_archive(path("results.json"));
  EXPECT_EQ(archive.results.rows.size(), 2);
  EXPECT_EQ(archive.scenario_json, "");
}

TEST_F(ArchiveReader, AReadErrorAtAnyByteIsAnError) {
  const auto read_all = [&] {
    Archive archive = read_archive(folder_.path().string());
    read_seed_details(archive);
  };
  std::size_t size = 0;
  for (const std::string& name : folder_.names()) size += content(path(name)).size();
  read_all();
  constexpr std::size_t kStep = 13;  // all would take seconds
  for (std::size_t left = 0; left <= size; left += kStep) {
    const ReadFault fault(size - left);
    EXPECT_THROW(read_all(), scenarios::InputError) << size - left;
  }
}

TEST_F(ArchiveReader, WhatIsNoFileIsRefusedAtOnce) {
  EXPECT_THROW(read_archive("/dev/zero"), scenarios::InputError);
  EXPECT_THROW(read_archive("/proc/self/mem"), scenarios::InputError);
}

TEST_F(ArchiveReader, ACutSeedFileIsRefused) {
  const std::string whole = content(path("frames.csv"));
  put(path("frames.csv"), whole.substr(0, whole.size() - 2));  // in mid-number
  Archive archive = read_archive(folder_.path().string());
  EXPECT_THROW(read_seed_details(archive), scenarios::InputError);
}

TEST_F(ArchiveReader, SeedsHaveTheirPulsesAndHosts) {
  Archive archive = read_archive(folder_.path().string());
  read_seed_details(archive);
  const evaluation::SeedScore& second = archive.results.rows[0].seeds[1];
  EXPECT_EQ(second.seed, 2);
  ASSERT_EQ(second.pulses.size(), 2);
  EXPECT_EQ(second.pulses[1].pulse, 226);
  EXPECT_EQ(second.pulses[1].spread_ms, 2);
  EXPECT_EQ(second.host_errors_ms, (std::vector<double>{0, -0.125}));
}

TEST_F(ArchiveReader, SaysWhereAnEditedValueIsWrong) {
  edit("results.json", "\"evaluated_pulses\": 960", "\"evaluated_pulses\": \"many\"");
  EXPECT_THAT(problem(), AllOf(HasSubstr("results.json:"), HasSubstr("/rows/0/evaluated_pulses"),
                               HasSubstr("found \"many\", allowed: a whole number from 0")));
}

TEST_F(ArchiveReader, RefusesANumberThatNoDoubleHolds) {
  edit("results.json", "\"evaluated_pulses\": 960", "\"evaluated_pulses\": 1e999");
  EXPECT_THAT(problem(),
              AllOf(HasSubstr("results.json:"), HasSubstr("the number 1e999 is too large")));
}

TEST_F(ArchiveReader, SaysWhatIsMissing) {
  edit("results.json", "\"seed_recall\"", "\"seed_recoil\"");
  EXPECT_THAT(problem(),
              AllOf(HasSubstr("/rows/0/gathering_score"), HasSubstr("'seed_recall' is missing")));
}

TEST_F(ArchiveReader, RefusesValuesThatAreNoSeeds) {
  edit("results.json", "\"count\": 2", "\"count\": 3");
  EXPECT_THAT(problem(), AllOf(HasSubstr("/rows/0/amd_ms/values"),
                               HasSubstr("found 2 values, allowed: 3, one for each seed")));
}

TEST_F(ArchiveReader, RefusesANewerSchema) {
  edit("results.json", "\"schema_version\": 1", "\"schema_version\": 2");
  edit("results.json", std::string(version()), "1.7.3");
  EXPECT_THAT(problem(),
              AllOf(HasSubstr("results.json:2: /schema_version: found 2, allowed: at most 1; a "
                              "newer simbench (1.7.3) wrote this and reads it; this is simbench"),
                    Not(HasSubstr("\n"))));
}

TEST_F(ArchiveReader, RefusesTheManifestOfAnotherScenario) {
  edit("manifest.json", "\"name\": \"3cam_1host_30fps\"", "\"name\": \"another\"");
  EXPECT_THAT(problem(), AllOf(HasSubstr("manifest.json"), HasSubstr("/scenario/name")));
}

TEST_F(ArchiveReader, RefusesDamagedLinesOfFrames) {
  edit("frames.csv", "225,1.5", "225;1.5");
  EXPECT_THAT(problem(), HasSubstr("frames.csv:2: allowed: exactly 5 cells"));
}

TEST_F(ArchiveReader, RefusesSeedsAndPipelinesThatResultsDoNotHave) {
  edit("frames.csv", "yoon2021_both,2,", "yoon2021_both,9,");
  EXPECT_THAT(problem(), HasSubstr("found seed 9, allowed: 1 to 2, the seeds"));
  edit("frames.csv", "yoon2021_both,1,", "yoon2020_both,1,");
  EXPECT_THAT(problem(), HasSubstr("found pipeline 'yoon2020_both'"));
}

TEST_F(ArchiveReader, SaysHowToMakeWhatIsNotThere) {
  EXPECT_THROW(read_archive("nowhere"), scenarios::InputError);
  std::filesystem::remove(path("results.json"));
  EXPECT_THAT(problem(), AllOf(HasSubstr("No such file"), HasSubstr("simbench run --output")));
}

// Whatever is cut off or turned over, the reader refuses it or reads it: it never fails otherwise.
TEST_F(ArchiveReader, SurvivesAnyDamage) {
  constexpr unsigned kSeed = 20210;
  std::minstd_rand random(kSeed);
  for (const std::string name : {"results.json", "manifest.json", "frames.csv", "hosts.csv"}) {
    const std::string good = content(name);
    for (int i = 0; i < 60; ++i) {
      std::string bad = good;
      const std::size_t at = random() % good.size();
      if (i % 2 == 0) {
        bad.resize(at);
      } else {
        bad[at] = static_cast<char>(random() % 256);
      }
      write(name, bad);
      EXPECT_NO_THROW(problem()) << name << " at " << at << ", seed " << kSeed;
      if (i % 2 == 0 && name == "results.json" && at + 2 < good.size()) {
        EXPECT_NE(problem(), "nothing") << "cut at " << at << ", seed " << kSeed;
      }
    }
    write(name, good);
  }
}

}  // namespace
}  // namespace simbench::reports
