#include "reports/results/results_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/answer_fields.h"
#include "reports/results/summary_document.h"
#include "tests/reports/sample_results.h"
#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string answer_text(const evaluation::Results& results,
                        std::optional<evaluation::Levers> levers = {}) {
  return whole_text(results_answer(results, std::move(levers)).text);
}

Json fields_of(const evaluation::Results& results, std::optional<evaluation::Levers> levers = {}) {
  const ResultsAnswer answer = results_answer(results, std::move(levers));
  return answer_with_fields(answer.data, answer.text, answer.levers ? &*answer.levers : nullptr);
}

evaluation::Lever lever_of(const std::string& what, double from, double to) {
  return {.what = what,
          .pipeline = "a+b+c",
          .sets = {{"/cameras/exposure_ms", "4"}},
          .from = from,
          .to = to};
}

// The sample, whose first row did its work and whose second gathered nothing.
evaluation::Results working_sample() {
  evaluation::Results results = sample_results();
  results.rows[0].unsynchronised_hosts = 0;
  return results;
}

// The values times these factors, so many seeds of each, and all pulses found whole.
evaluation::Results pipelines_of(const std::vector<std::pair<const char*, double>>& factors,
                                 int seeds) {
  evaluation::Results results = working_sample();
  const evaluation::Row both = results.rows.front();
  results.rows.clear();
  for (const auto& [pipeline, factor] : factors) {
    evaluation::Row& row = results.rows.emplace_back(both);
    row.pipeline = pipeline;
    row.published.reset();
    row.sets = {.emitted = 960,
                .pure = 960,
                .complete_pulses = 960,
                .due_pulses = 960,
                .exposed_pulses = 960};
    row.precision = row.recall = 1;
    std::vector<double> amd_ms;
    for (int seed = 0; seed < seeds; ++seed) amd_ms.push_back(factor * (1 + 0.01 * (seed % 7)));
    row.amd_ms = evaluation::make_series(amd_ms);
  }
  return results;
}

TEST(ResultsAnswer, NamesTheBestWithItsBand) {
  const std::string text = answer_text(pipelines_of({{"a", 2}, {"b", 3}}, 20));
  EXPECT_THAT(text, HasSubstr("a is the best of the 2 pipelines that a rig can run: AMD 2.06 ms "
                              "(5-95 %: [2.00, 2.12] ms). The next, b, has 1.50 [1.50, 1.50] "
                              "times as much."));
}

TEST(ResultsAnswer, SaysInTheLeadThatOthersCannotBeToldFromIt) {
  EXPECT_THAT(answer_text(pipelines_of({{"a", 2}, {"b", 2}, {"c", 3}}, 20)),
              HasSubstr("a, with 1 that these seeds cannot tell from it, is the best of the 3 "
                        "pipelines that a rig can run: AMD 2.06 ms (5-95 %: [2.00, 2.12] ms). Not "
                        "told apart: b. The next, c,"));
}

TEST(ResultsAnswer, OfTooFewSeedsItSaysHowManyWouldDo) {
  EXPECT_THAT(answer_text(pipelines_of({{"a", 2}, {"b", 2000}, {"c", 3000}}, 4)),
              HasSubstr("a has the smallest AMD of the 3 pipelines that a rig can run, in too few "
                        "seeds for a verdict: 2.03 ms (5-95 %: [2.00, 2.06] ms). 4 seeds are too "
                        "few for a verdict (7 would do); in all 4 it has less than b and c."));
  EXPECT_THAT(answer_text(pipelines_of({{"a", 2}, {"b", 3}}, 1)),
              HasSubstr("1 seed is too few for a verdict (6 would do); in this one it has less "
                        "than b."));
}

// The limit's median may be a little larger or smaller than the best one's: neither is a finding.
TEST(ResultsAnswer, ALimitThatSeedsCannotTellFromTheRowIsNoFactor) {
  for (const double limit_ms : {1.999, 2.0, 2.001}) {
    evaluation::Results results = pipelines_of({{"a", 2}, {"clocks", limit_ms}}, 20);
    results.rows[1].host_sync = "oracle";
    std::vector<double> amd_ms;
    for (int seed = 0; seed < 20; ++seed) {
      amd_ms.push_back(limit_ms * (1 + 0.01 * (seed % 5)));
    }
    results.rows[1].amd_ms = evaluation::make_series(amd_ms);
    EXPECT_THAT(answer_text(results), HasSubstr("which these seeds cannot tell from what it has."))
        << limit_ms;
  }
  evaluation::Results results = pipelines_of({{"a", 2}, {"clocks", 1}}, 20);
  results.rows[1].host_sync = "oracle";
  EXPECT_THAT(
      answer_text(results),
      HasSubstr("Perfect host clocks would give it 1.03 ms; it has 2.00 times that limit."));
  results = pipelines_of({{"a", 2}, {"clocks", 3}}, 20);
  results.rows[1].host_sync = "oracle";
  EXPECT_THAT(answer_text(results), HasSubstr("3.09 ms, more than it has: errors of the clocks"));
}

TEST(ResultsAnswer, WhatFailedIsNamedAndNotRanked) {
  EXPECT_THAT(answer_text(working_sample()),
              HasSubstr("yoon2021_both is the only pipeline that a rig can run and that did not "
                        "fail: AMD 2.00 ms (5-95 %: [1.50, 2.50] ms). free_running failed: no "
                        "pulse was delivered by all cameras."));
  evaluation::Results results = pipelines_of({{"a", 2}, {"b", 3}}, 20);
  for (evaluation::Row& row : results.rows) row.sets.pure = 0;
  EXPECT_THAT(answer_text(results), HasSubstr("Every pipeline that a rig can run failed. a and b "
                                              "failed: no gathered set is of one pulse."));
}

TEST(ResultsAnswer, DoubtsSetsThatLackPulses) {
  EXPECT_THAT(
      answer_text(working_sample()),
      HasSubstr("Do not trust its sets: 0 of 720 mix pulses; of 960 pulses that all cameras "
                "delivered 720 are found whole."))
      << "an older archive does not know how many were due";
}

TEST(ResultsAnswer, TrustsSetsWithoutAFault) {
  EXPECT_THAT(answer_text(pipelines_of({{"a", 2}}, 20)),
              HasSubstr("Its sets can be trusted here: none of 960 mixes pulses, no pulse is "
                        "missing, with 8.50 ms to spare."));
}

// Half of the pulses were not exposed: all that came was found, and half is missing.
TEST(ResultsAnswer, PulsesThatWereDueAndNeverCameAreInTheLead) {
  evaluation::Results results = pipelines_of({{"a", 2}}, 20);
  results.rows[0].sets = {.emitted = 470,
                          .pure = 470,
                          .complete_pulses = 470,
                          .due_pulses = 960,
                          .exposed_pulses = 480};
  results.loss_reasons = {"/cameras/exposure_ms: too long"};
  const AnswerText answer = results_answer(results).text;
  EXPECT_THAT(answer.lead,
              HasSubstr("But 51.0 % of the 960 pulses due are lost: 480 not exposed by "
                        "all cameras, 10 exposed and not delivered by all. "
                        "/cameras/exposure_ms: too long."));
  const std::string text = whole_text(answer);
  EXPECT_THAT(text, HasSubstr("none of 470 mixes pulses, with 8.50 ms to spare; of 960 pulses due "
                              "480 were exposed by all cameras, 470 delivered by all and 470 found "
                              "whole."));
  EXPECT_THAT(text, Not(HasSubstr("no pulse is missing")));
}

TEST(ResultsAnswer, LeversAreFromOneValueToAnotherInOneUnit) {
  evaluation::Levers levers{.seeds = 32, .algorithms = 80, .changes = 7};
  levers.effective = {lever_of("device_time x", 2.92, 0.0189),
                      lever_of("equal exposures", 2.92, 2)};
  levers.effective[1].missing_from = 0.75;
  levers.effective[1].missing_to = 0;
  const std::string text = answer_text(working_sample(), levers);
  EXPECT_THAT(text, HasSubstr("With device_time x: AMD from 2.92 to 0.0189 ms. With equal "
                              "exposures: pulses due and not found whole from 75.0 % to 0 %."));
  const Json fields = fields_of(working_sample(), levers)["levers"];
  EXPECT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0]["from"], 2.92);
  EXPECT_EQ(fields[0]["metric"], "amd_ms");
  EXPECT_EQ(fields[0]["options"], "--pipelines a+b+c --set /cameras/exposure_ms=4");
}

TEST(ResultsAnswer, WarningsAreLinesUnlessTheFirstSentenceHasThem) {
  evaluation::Results results = pipelines_of({{"a", 2}}, 20);
  results.warnings = {"the links are asymmetric"};
  results.rows[0].notes = {"repetition 3: no frames", "repetition 4: no frames"};
  const std::vector<std::string> of_world = {"--set /cameras/exposure_ms=40: too long"};
  EXPECT_THAT(whole_text(results_answer(results, {}, of_world).text),
              HasSubstr("--set /cameras/exposure_ms=40: too long. the links are asymmetric. 2 "
                        "notes of a: repetition 3: no frames."));
  results.rows[0].sets.complete_pulses = results.rows[0].sets.pure = 400;
  results.loss_reasons = {"/cameras/exposure_ms: too long"};
  const AnswerText lost = results_answer(results, {}, of_world).text;
  EXPECT_THAT(lost.lead, HasSubstr("/cameras/exposure_ms: too long"));
  EXPECT_THAT(whole_text(lost), Not(HasSubstr("--set")));
}

TEST(ResultsAnswer, SaysThatNothingTriedHelps) {
  const evaluation::Levers levers{.seeds = 1, .algorithms = 80, .changes = 1};
  EXPECT_THAT(answer_text(pipelines_of({{"a", 2}}, 20), levers),
              HasSubstr("Nothing that was tried improves it by 5 % (over 1 seed): 80 other "
                        "algorithms and 1 change of the rig."));
  EXPECT_THAT(answer_text(working_sample()), Not(HasSubstr("tried")));
  EXPECT_TRUE(fields_of(working_sample())["levers"].is_null());
}

TEST(ResultsAnswer, SaysThatAmdHidesWhatAllCamerasShare) {
  EXPECT_THAT(answer_text(working_sample()),
              HasSubstr("AMD hides that all cameras are 29.0 ms off together"));
}

TEST(ResultsAnswer, SaysSoWhereThereIsNoAnswer) {
  EXPECT_EQ(answer_text({}), "No pipeline that a rig can run has a result here.");
}

TEST(ResultsAnswer, ForProgramsHasWhatIsBehindIt) {
  const Json json = fields_of(working_sample());
  EXPECT_EQ(json["ranked_by"], "amd_ms");
  EXPECT_EQ(json["best"], "yoon2021_both");
  EXPECT_EQ(json["failed"][0]["pipeline"], "free_running");
  EXPECT_TRUE(json["pulses"].is_null()) << "how many were due is not known";
  const evaluation::Results three = pipelines_of({{"a", 2}, {"b", 2}, {"c", 3}}, 20);
  const Json fields = fields_of(three);
  EXPECT_EQ(fields["not_told_apart"], Json::array({"b"}));
  EXPECT_EQ(fields["next"]["pipeline"], "c");
  EXPECT_EQ(fields["too_few_seeds"], false);
  EXPECT_EQ(fields["pulses"]["due"], 960);
  EXPECT_EQ(fields["pulses"]["mixed_sets"], 0);
  const evaluation::Results few = pipelines_of({{"a", 2}, {"b", 3}}, 2);
  EXPECT_EQ(fields_of(few)["seeds_needed"], 6);
}

TEST(Summary, HasTheAnswerATableAndWhatFailed) {
  const AnswerText answer = results_answer(working_sample()).text;
  const std::string text = plain(summary_document(sample_results(), {.summary = "A fit."}, answer));
  EXPECT_THAT(text, HasSubstr("sample: 2 seeds (1-2)\nyoon2021_both is the only"));
  EXPECT_THAT(text, HasSubstr("2.00 ms"));
  EXPECT_THAT(text, HasSubstr("host synchronisation failed once"));
  EXPECT_THAT(text, Not(HasSubstr("RMDV")));
  const std::string quiet = plain(quiet_document(sample_results(), answer));
  EXPECT_THAT(quiet, Not(HasSubstr("pipeline  ")));
  EXPECT_THAT(quiet, HasSubstr("host synchronisation failed once"));
}

}  // namespace
}  // namespace simbench::reports
