#include "reports/comparison/baseline.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "reports/comparison/comparison_scenarios.h"
#include "reports/text/output_file.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/reports/sample_archive.h"
#include "tests/scratch_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;
using scenarios::InputError;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class BaselineFile : public testing::Test {
 protected:
  std::string content() const { return folder_.content("b.json"); }
  void overwrite(const std::string& text) const { folder_.write("b.json", text); }
  void edit(const std::string& what, const std::string& by) const {
    std::string text = content();
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    overwrite(text.replace(at, what.size(), by));
  }
  auto reading() const {
    return [this] { read_baseline(path_); };
  }

  const ScratchFolder folder_;
  const std::string path_ = folder_ / "b.json";
};

TEST_F(BaselineFile, ReadsWhatItWrote) {
  Archive archive = sample_archive("a", 5, 3);
  const double third = 1.0 / 3;
  archive.results.rows[1].amd_ms.values = {third, std::numeric_limits<double>::quiet_NaN(), 0};
  write_baseline(make_baseline(archive), path_);
  const Baseline read = read_baseline(path_);
  EXPECT_EQ(read.scenario, "sample");
  EXPECT_EQ(read.version, "1.2.3");
  EXPECT_EQ(read.commit, "abc");
  EXPECT_EQ(read.seeds.first, 5U);
  EXPECT_EQ(read.seeds.count, 3U);
  ASSERT_EQ(read.pipelines.size(), 2U);
  EXPECT_EQ(read.pipelines[1].name, "good");
  const std::vector<double>& amd = read.pipelines[1].values[0];
  EXPECT_NEAR(amd[0], third, 1e-12);
  EXPECT_TRUE(std::isnan(amd[1]));
  EXPECT_EQ(amd[2], 0);
  EXPECT_EQ(read.margins[0].relative, evaluation::metric("amd_ms").judged->margin.relative);
  EXPECT_THAT(folder_.names(), ElementsAre("b.json")) << "no temporary file is left";
}

TEST_F(BaselineFile, ALinePerMetricAndTwelveDigits) {
  Archive archive = sample_archive("a", 1, 1);
  archive.results.rows[0].amd_ms.values = {2.0 / 3};
  EXPECT_THAT(baseline_json(make_baseline(archive)),
              HasSubstr("\n      \"amd_ms\": [0.666666666667],\n"));
}

TEST_F(BaselineFile, HasMetricsOfSteeredExposuresWhereAPipelineHasThem) {
  Archive archive = sample_archive("a", 1, 2);
  const Baseline unsteered = make_baseline(archive);
  EXPECT_THAT(baseline_json(unsteered), testing::Not(HasSubstr("disturbed_frames")));
  write_baseline(unsteered, path_);
  EXPECT_EQ(read_baseline(path_).judged, unsteered.judged);
  archive.results.rows[1].disturbed_frames = evaluation::make_series({3, 4});
  archive.results.rows[0].disturbed_frames =
      evaluation::make_series({evaluation::kNan, evaluation::kNan});
  write_baseline(make_baseline(archive), path_);
  const Baseline read = read_baseline(path_);
  ASSERT_EQ(read.judged.size(), unsteered.judged.size() + 1);
  EXPECT_STREQ(read.judged.back()->id, "disturbed_frames");
  EXPECT_THAT(read.pipelines[1].values.back(), ElementsAre(3, 4));
  EXPECT_EQ(read.margins.back().absolute, 0.5);
}

TEST_F(BaselineFile, MarginsMayBeEdited) {
  write_baseline(make_baseline(sample_archive("a")), path_);
  edit("\"relative\":0.02", "\"relative\":0.2");
  EXPECT_EQ(read_baseline(path_).margins[0].relative, 0.2);
  edit("\"relative\":0.2", "\"relative\":-1");
  EXPECT_THAT(reading(),
              ThrowsMessage<InputError>(
                  AllOf(HasSubstr("b.json:"), HasSubstr("/margins/amd_ms/relative: found -1"))));
}

TEST_F(BaselineFile, WhatElseIsEditedShows) {
  const Baseline written = make_baseline(sample_archive("a", 1, 2));
  write_baseline(written, path_);
  edit("\"amd_ms\": [", "\"amd_ms\": [1");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("/pipelines_digest")));
  write_baseline(written, path_);
  edit("{\"latency_fixed_ms\":0.1}", "{\"latency_fixed_ms\":0.2}");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("/scenario_digest")));
  write_baseline(written, path_);
  edit("\"count\":2", "\"count\":3");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(
                             HasSubstr("found 2 values, allowed: 3, one for each seed")));
  write_baseline(written, path_);
  edit("\"pipeline\": \"good\"", "\"pipeline\": \"plain\"");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("each pipeline once")));
  write_baseline(written, path_);
  edit("simbench baseline", "something else");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("/kind")));
}

TEST_F(BaselineFile, AValueThatItsMetricCannotHaveIsRefused) {
  Baseline written = make_baseline(sample_archive("a", 1, 2));
  written.pipelines[1].values[0][1] = -0.5;
  write_baseline(written, path_);
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(AllOf(
                             HasSubstr("b.json:"), HasSubstr("/pipelines/1/amd_ms/1: found -0.5"),
                             HasSubstr("allowed: a number from 0"))));
  written = make_baseline(sample_archive("a", 1, 2));
  written.pipelines[0].values.back()[0] = 1.5;
  write_baseline(written, path_);
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("allowed: a share from 0 to 1")));
}

TEST_F(BaselineFile, ANewerOneIsForANewerProgram) {
  write_baseline(make_baseline(sample_archive("a")), path_);
  edit("\"schema_version\": 1", "\"schema_version\": 2");
  EXPECT_THAT(reading(), ThrowsMessage<InputError>(AllOf(HasSubstr("b.json:2: /schema_version"),
                                                         HasSubstr("a newer simbench"))));
}

// Wherever it is cut: refused, with the file's name.
TEST_F(BaselineFile, CutShortItIsRefused) {
  write_baseline(make_baseline(sample_archive("a", 1, 2)), path_);
  const std::string whole = content();
  for (std::size_t length = 0; length + 2 < whole.size(); length += 97) {
    overwrite(whole.substr(0, length));
    EXPECT_THAT(reading(), ThrowsMessage<InputError>(HasSubstr("b.json"))) << length;
  }
}

TEST_F(BaselineFile, NeedsTheScenario) {
  Archive archive = sample_archive("alone.json");
  archive.scenario_json.clear();
  EXPECT_THAT([&] { make_baseline(archive); },
              ThrowsMessage<InputError>(HasSubstr("alone.json: a results.json alone")));
}

TEST_F(BaselineFile, WhereNothingCanBeWrittenNothingIsLeft) {
  const Baseline baseline = make_baseline(sample_archive("a"));
  EXPECT_THROW(write_baseline(baseline, folder_ / "no/b.json"), OutputError);
  EXPECT_THROW(write_baseline(baseline, folder_.path().string()), OutputError);
  EXPECT_THROW(write_baseline(baseline, "/dev/null"), OutputError);
  EXPECT_TRUE(folder_.names().empty());
}

// Each is of the scenario it is named after, as that is now: else tools/check could not hold a
// build to it.
TEST(CommittedBaselines, FitTheirScenarios) {
  int count = 0;
  for (const auto& entry :
       nonempty(fs::directory_iterator(SIMBENCH_SOURCE_DIR "/reports/baselines"))) {
    const Baseline baseline = read_baseline(entry.path().string());
    EXPECT_EQ(baseline.scenario, entry.path().stem().string());
    EXPECT_EQ(seeds_text(baseline.seeds), "1-32");
    const std::string now = scenarios::load_scenario(baseline.scenario).resolved_json();
    EXPECT_THAT(compare_scenarios(baseline.scenario_json, now).world, testing::IsEmpty());
    ++count;
  }
  EXPECT_EQ(count, 4);
}

}  // namespace
}  // namespace simbench::reports
