#include "reports/comparison/gate.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/text/json_node.h"
#include "scenarios/loader.h"
#include "tests/reports/sample_archive.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using scenarios::InputError;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

// The sample, whose pipelines found their sets.
template <class... More>
Archive working_archive(const std::string& path, const More&... more) {
  Archive archive = sample_archive(path, more...);
  for (evaluation::Row& row : archive.results.rows) {
    row.sets.emitted = row.sets.pure = row.sets.complete_pulses = 960;
  }
  return archive;
}

Baseline baseline_of(const Archive& archive) {
  Baseline baseline = make_baseline(archive);
  baseline.path = "b.json";
  return baseline;
}

// The sample with the AMD of "good" (2 ms) scaled.
Archive scaled(double factor) {
  Archive archive = working_archive("now");
  scale(archive.results.rows[1].amd_ms, factor);
  return archive;
}

const GateCheck& amd_of_good(const GateReport& report) { return report.checks.at(4); }

GateReport exact(const Archive& now) {
  return gate(now, baseline_of(working_archive("before")), GateMode::kExact);
}

GateReport statistical(const Archive& now) {
  return gate(now, baseline_of(working_archive("before")), GateMode::kStatistical);
}

TEST(ExactGate, EqualResultsPass) {
  const GateReport report = exact(working_archive("now"));
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.count(GateOutcome::kSame), 8U);
  EXPECT_THAT(report.notes, IsEmpty());
}

TEST(ExactGate, APipelineThatFailedIsSaid) {
  Archive now = working_archive("now");
  now.results.rows[1].unsynchronised_hosts = 3;
  EXPECT_THAT(exact(now).notes,
              Contains(HasSubstr("good failed, so its values say little: hosts were not "
                                 "synchronised (3 over all seeds)")));
}

TEST(ExactGate, RoundingIsNoChangeAndAMillionthIs) {
  EXPECT_EQ(amd_of_good(exact(scaled(1 + 1e-11))).outcome, GateOutcome::kSame);
  const GateReport report = exact(scaled(1 + 1e-6));
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(amd_of_good(report).outcome, GateOutcome::kChanged);
  EXPECT_EQ(amd_of_good(report).changed_seeds, 32U);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("--save-baseline")));
}

TEST(ExactGate, TheMarginDecides) {
  EXPECT_TRUE(exact(scaled(1.019)).passed());
  const GateReport worse = exact(scaled(1.021));
  EXPECT_FALSE(worse.passed());
  EXPECT_EQ(amd_of_good(worse).outcome, GateOutcome::kFailed);
  EXPECT_EQ(worse.count(GateOutcome::kFailed), 1U);
  const GateReport better = exact(scaled(0.9));
  EXPECT_TRUE(better.passed());
  EXPECT_EQ(amd_of_good(better).outcome, GateOutcome::kBetter);
}

TEST(ExactGate, AValueThatIsLostFailsWithoutANan) {
  for (const std::size_t lost : {1U, 32U}) {
    Archive now = working_archive("now");
    std::fill_n(now.results.rows[1].amd_ms.values.begin(), lost, kNaN);
    const GateReport report = exact(now);
    EXPECT_EQ(amd_of_good(report).outcome, GateOutcome::kFailed);
    EXPECT_THAT(gate_text(report), HasSubstr("of 32 seeds lost their"));
    for (const std::string& text : {gate_text(report), gate_junit(report), gate_json(report)}) {
      EXPECT_THAT(text, Not(HasSubstr("nan")));
    }
    EXPECT_THAT(gate_junit(report), HasSubstr("<failure message=\"AMD of good"));
  }
}

TEST(ExactGate, ChecksWithoutAnyValueAreNoted) {
  Archive empty = working_archive("before");
  std::vector<double>& values = empty.results.rows[1].amd_ms.values;
  values.assign(values.size(), kNaN);
  const GateReport report = gate(empty, baseline_of(empty), GateMode::kExact);
  EXPECT_TRUE(report.passed());
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("1 of 8 checks show nothing")));
}

TEST(ExactGate, AValueThatIsNewIsAChange) {
  Archive before = working_archive("before");
  std::vector<double>& values = before.results.rows[1].amd_ms.values;
  values.assign(values.size(), kNaN);
  const GateReport report = gate(working_archive("now"), baseline_of(before), GateMode::kExact);
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(amd_of_good(report).outcome, GateOutcome::kChanged);
  EXPECT_THAT(gate_text(report), HasSubstr("did not exist"));
  EXPECT_THAT(gate_text(report), Not(HasSubstr("nan")));
}

TEST(StatisticalGate, OfOtherSeedsMostValuesMustStillExist) {
  Archive now = working_archive("now", 101);
  std::vector<double>& values = now.results.rows[1].amd_ms.values;
  std::fill_n(values.begin(), values.size() / 2, kNaN);
  EXPECT_TRUE(statistical(now).passed());
  values[values.size() / 2] = kNaN;
  const GateReport report = statistical(now);
  EXPECT_TRUE(report.by_index);
  EXPECT_EQ(amd_of_good(report).outcome, GateOutcome::kFailed);
  EXPECT_THAT(gate_text(report), Not(HasSubstr("nan")));
}

TEST(ExactGate, SmallValuesHaveAnAbsoluteMargin) {
  Archive before = working_archive("before");
  scale(before.results.rows[1].amd_ms, 0.001);  // 2 us, of which 2 % would be nothing
  Archive now = before;
  for (double& value : now.results.rows[1].amd_ms.values) value += 0.0009;
  EXPECT_TRUE(gate(now, baseline_of(before), GateMode::kExact).passed());
  for (double& value : now.results.rows[1].amd_ms.values) value += 0.0002;
  EXPECT_FALSE(gate(now, baseline_of(before), GateMode::kExact).passed());
}

TEST(ExactGate, OfRecallTheMeanCountsAndLessIsWorse) {
  Archive now = working_archive("now");
  std::vector<double>& recall = now.results.rows[0].seed_recall.values;
  recall[3] = 0.9;  // mean 0.997
  EXPECT_TRUE(exact(now).passed());
  recall[4] = 0;  // its median stays 1
  const GateReport report = exact(now);
  EXPECT_FALSE(report.passed());
  EXPECT_THAT(check_text(report, report.checks.at(3)),
              HasSubstr("recall of plain in sample, seeds 1-32: mean 96.6 %"));
}

TEST(ExactGate, AValueThatVanishedFails) {
  Archive now = working_archive("now");
  now.results.rows[1].amd_ms.values[7] = kNaN;
  const GateReport report = exact(now);
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(amd_of_good(report).lost_seeds, 1U);
  EXPECT_THAT(check_text(report, amd_of_good(report)), HasSubstr("1 of 32 seeds lost their value"));
  // One that appeared does not.
  Archive before = working_archive("before");
  before.results.rows[1].amd_ms.values[7] = kNaN;
  EXPECT_TRUE(gate(working_archive("now"), baseline_of(before), GateMode::kExact).passed());
}

TEST(ExactGate, PipelinesThatVanishedFailAndNewOnesAreSaid) {
  Archive now = working_archive("now");
  now.results.rows[0].pipeline = "new";
  const GateReport report = exact(now);
  EXPECT_FALSE(report.passed());
  EXPECT_THAT(report.vanished_pipelines, ElementsAre("plain"));
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("so not checked: new")));
  EXPECT_THAT(gate_text(report), HasSubstr("the pipeline plain of the baseline is not in the"));
}

TEST(ExactGate, WantsTheSeedsOfTheBaseline) {
  EXPECT_THAT([] { exact(working_archive("now", 2, 32)); },
              ThrowsMessage<InputError>(
                  AllOf(HasSubstr("--first-seed 1 --seeds 32"), HasSubstr("--mode statistical"))));
}

TEST(Gate, WantsTheWorldOfTheBaselineButNotItsAlgorithms) {
  Archive now = working_archive("now");
  std::string& scenario = now.scenario_json;
  scenario.replace(scenario.find("100"), 3, "5");
  EXPECT_THAT(exact(now).notes,
              ElementsAre(HasSubstr("/algorithms/yoon2021/stamps: 100 against 5")));
  scenario.replace(scenario.find("0.1"), 3, "9.5");
  EXPECT_THAT([&] { exact(now); },
              ThrowsMessage<InputError>(HasSubstr("/network/latency_fixed_ms: 0.1 against 9.5")));
  EXPECT_THAT([&] { statistical(now); }, ThrowsMessage<InputError>(HasSubstr("another world")));
  scenario.clear();
  EXPECT_THAT(exact(now).notes, ElementsAre(HasSubstr("not checked")));
  now.results.scenario = "other";
  EXPECT_THAT([&] { exact(now); }, ThrowsMessage<InputError>(
                                       HasSubstr("of the scenario other, the baseline b.json of")));
}

TEST(StatisticalGate, FailsWhereWorseIsBothMuchAndSure) {
  const GateReport much = statistical(scaled(1.2));
  EXPECT_EQ(amd_of_good(much).outcome, GateOutcome::kFailed);
  EXPECT_FALSE(much.passed());
  EXPECT_GT(amd_of_good(much).difference.low, 0);
  EXPECT_TRUE(statistical(scaled(1.015)).passed());  // sure, but within the margin
  EXPECT_EQ(amd_of_good(statistical(scaled(0.8))).outcome, GateOutcome::kBetter);
  // A few seeds that are far worse: much, but not sure.
  Archive now = working_archive("now");
  now.results.rows[1].amd_ms.values[5] += 30;
  const GateReport unsure = statistical(now);
  EXPECT_TRUE(unsure.passed());
  EXPECT_EQ(amd_of_good(unsure).outcome, GateOutcome::kPossible);
  EXPECT_THAT(gate_text(unsure), HasSubstr("possibly worse"));
}

TEST(StatisticalGate, TheIntervalIsCorrectedForAllChecks) {
  const GateReport report = statistical(scaled(1.2));
  EXPECT_NEAR(amd_of_good(report).confidence, 1 - 0.05 / 8, 1e-12);  // the surest of eight
}

TEST(StatisticalGate, OtherSeedsArePairedByIndex) {
  const GateReport report = statistical(working_archive("now", 33, 40));
  EXPECT_TRUE(report.by_index);
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.seeds.first, 33U);
  EXPECT_EQ(report.seeds.count, 32U);
  EXPECT_THAT(gate_text(report), HasSubstr("seeds 33-64 against 1-32"));
  EXPECT_FALSE(statistical(working_archive("now", 1, 40)).by_index);
  EXPECT_THAT([] { statistical(working_archive("now", 33, 31)); },
              ThrowsMessage<InputError>(HasSubstr("at least 32")));
}

TEST(StatisticalGate, ValuesThatVanishFailWhereThatIsNoChance) {
  Archive now = working_archive("now");
  now.results.rows[1].amd_ms.values[7] = kNaN;
  EXPECT_FALSE(statistical(now).passed());
  Archive others = working_archive("now", 101, 32);
  others.results.rows[1].amd_ms.values[7] = kNaN;
  EXPECT_TRUE(statistical(others).passed());
  others.results.rows[1].amd_ms.values.assign(32, kNaN);
  EXPECT_FALSE(statistical(others).passed());
}

TEST(GateText, NamesAllThatIsNeededToRepeatAFailure) {
  const std::string text = gate_text(exact(scaled(1.5)));
  for (const char* part :
       {"gate FAILED: 1 of 8 checks (exact)", "AMD of good in sample, seeds 1-32", "(+50 %)",
        "32 of 32 seeds changed", "simbench run --scenario 'my sample.json'",
        "simbench gate now --baseline b.json"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(gate_text(exact(working_archive("now"))),
              AllOf(HasSubstr("gate passed: 8 checks, 8 of them the same"),
                    Not(HasSubstr("To reproduce"))));
}

TEST(GateMarkdown, SaysWhatFailedAndHowToRepeatIt) {
  const GateReport report = exact(scaled(1.5));
  const std::string text = gate_markdown(report);
  EXPECT_TRUE(text.starts_with("## sample: gate FAILED: 1 of 8 checks (exact)\n\n")) << text;
  EXPECT_THAT(text, HasSubstr("\n- FAILED: " + check_text(report, amd_of_good(report)) + "\n"));
  EXPECT_THAT(text, HasSubstr("\n### What changed\n\n| pipeline | metric | baseline | now |"));
  EXPECT_THAT(text, HasSubstr("\n| good | AMD |"));
  EXPECT_THAT(text,
              HasSubstr("\n### To reproduce\n\n    simbench run --scenario 'my sample.json'"));
  EXPECT_TRUE(text.ends_with("\n    simbench gate now --baseline b.json\n")) << text;
}

TEST(GateMarkdown, OfAPassedGateHasTheNumbersAndNoMore) {
  const std::string text = gate_markdown(exact(working_archive("now")));
  EXPECT_TRUE(text.starts_with("## sample: gate passed: 8 checks, 8 of them the same (exact)\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("sample, seeds 1-32: now against the baseline b.json"),
                          Not(HasSubstr("FAILED")), Not(HasSubstr("###"))));
}

// Names are anyone's: none begins a heading, a list or code of its own.
TEST(GateMarkdown, ShowsNamesAsText) {
  Archive before = working_archive("before");
  Archive now = scaled(1.5);
  for (Archive* archive : {&before, &now}) {
    for (evaluation::Row& row : archive->results.rows) row.pipeline += "|\n# no";
  }
  now.results.rows.push_back(now.results.rows.front());
  now.results.rows.back().pipeline = "new\n# no";
  GateReport report = gate(now, baseline_of(before), GateMode::kExact);
  EXPECT_FALSE(report.passed());
  report.reproduce.push_back("simbench run '\n# no'");
  const std::string text = gate_markdown(report);
  EXPECT_THAT(text, AllOf(HasSubstr("- FAILED: AMD of good|\\x0a# no in sample"),
                          HasSubstr("| good\\|\\x0a# no |"), HasSubstr("new\\x0a# no"),
                          HasSubstr("\n    simbench run '\\x0a# no'\n")));
  EXPECT_THAT(text, Not(HasSubstr("\n# no")));
}

TEST(GateCommands, OfAResultAloneAreMadeUpFromWhatItTells) {
  Archive now = scaled(1.5);
  now.command.clear();
  EXPECT_THAT(exact(now).reproduce,
              ElementsAre("simbench run --scenario sample --first-seed 1 --seeds 32 --pipelines "
                          "plain,good --output results",
                          "simbench gate results --baseline b.json"));
  EXPECT_EQ(shell_line({"a b", "it's", "", "/x=1"}), "'a b' 'it'\\''s' '' /x=1");
}

TEST(GateJson, HoldsEveryCheck) {
  const Json failed = Json::parse(gate_json(statistical(scaled(1.5))));
  EXPECT_EQ(failed["passed"], false);
  EXPECT_EQ(failed["mode"], "statistical");
  ASSERT_EQ(failed["checks"].size(), 8U);
  EXPECT_EQ(failed["checks"][4]["outcome"], "failed");
  EXPECT_GT(failed["checks"][4]["difference"]["low"], 0);
  const Json passed = Json::parse(gate_json(exact(working_archive("now"))));
  EXPECT_EQ(passed["passed"], true);
  EXPECT_FALSE(passed["checks"][4].contains("difference"));
}

}  // namespace
}  // namespace simbench::reports
