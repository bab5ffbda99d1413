#include "reports/comparison/comparison.h"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "reports/comparison/comparison_scenarios.h"
#include "reports/text/json_node.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/reports/sample_archive.h"

namespace simbench::reports {
namespace {

using evaluation::Verdict;
using scenarios::InputError;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

void replace(std::string& text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
}

TEST(SeedPairing, HoldsWhatBothHave) {
  const SeedPairing pairing = pair_by_seed({1, 10}, {8, 10});
  EXPECT_EQ(pairing.count, 3U);
  EXPECT_THAT(pairing.of_a({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), ElementsAre(8, 9, 10));
  EXPECT_THAT(pairing.of_b({8, 9, 10, 11, 12, 13, 14, 15, 16, 17}), ElementsAre(8, 9, 10));
  EXPECT_EQ(pair_by_seed({1, 10}, {11, 10}).count, 0U);
  EXPECT_EQ(pair_by_seed({20, 5}, {1, 10}).count, 0U);
  EXPECT_EQ(pair_by_index({1, 10}, {100, 4}).count, 4U);
  EXPECT_EQ(seeds_text({7, 1}), "7");
  EXPECT_EQ(seeds_text({7, 3}), "7-9");
}

TEST(CompareArchives, TheSameArchiveTwiceShowsNoDifference) {
  const Archive a = sample_archive("a");
  const Comparison c = compare_archives(a, a, {});
  ASSERT_EQ(c.pipelines.size(), 2U);
  for (const ComparedPipeline& pipeline : c.pipelines) {
    for (const auto& metric : nonempty(pipeline.metrics)) {
      EXPECT_EQ(metric.verdict, Verdict::kNoDifferenceSeen);
      EXPECT_EQ(metric.pairs, 32U);
    }
  }
  EXPECT_THAT(c.notes, IsEmpty());
}

TEST(CompareArchives, SteeredExposuresAreJudgedWhereThereAreSome) {
  Archive a = sample_archive("a");
  EXPECT_THAT(comparison_csv(compare_archives(a, a, {})), Not(HasSubstr("exposure_spread")));
  Archive b = a;
  for (Archive* archive : {&a, &b}) {
    const std::size_t seeds = archive->results.seed_count;
    const double spread_ms = archive == &a ? 2 : 1;
    for (evaluation::Row& row : archive->results.rows) {
      const bool is_first = row.pipeline == archive->results.rows.front().pipeline;
      row.exposure_spread_median_ms = evaluation::make_series(
          std::vector<double>(seeds, is_first ? spread_ms : evaluation::kNan));
    }
  }
  const auto found = Json::parse(comparison_json(compare_archives(a, b, {})))["pipelines"];
  EXPECT_EQ(found[0]["exposure_spread_median_ms"]["verdict"], "better");
  EXPECT_EQ(found[1]["exposure_spread_median_ms"]["pairs"], 0);
  EXPECT_FALSE(found[0].contains("exposure_spread_p95_ms")) << "no row has it";
}

TEST(CompareArchives, CommonSeedsAndPipelinesAreComparedAndTheRestIsSaid) {
  const Archive a = sample_archive("a", 1, 32);
  Archive b = sample_archive("b", 11, 32);
  b.version = "1.3.0";
  b.commit = "def";
  b.results.rows[0].pipeline = "other";
  scale(b.results.rows[1].amd_ms, 0.5);
  replace(b.scenario_json, "\"stamps\": 100", "\"stamps\": 50");
  const Comparison c = compare_archives(a, b, {});
  EXPECT_EQ(c.first_seed_a, 11U);
  EXPECT_EQ(c.first_seed_b, 11U);
  EXPECT_EQ(c.seed_count, 22U);
  ASSERT_EQ(c.pipelines.size(), 1U);
  // Paired by seed, all that differs is the factor.
  EXPECT_NEAR(c.pipelines[0].metrics[0].ratio.low, 0.5, 1e-12);
  EXPECT_NEAR(c.pipelines[0].metrics[0].ratio.high, 0.5, 1e-12);
  EXPECT_EQ(c.pipelines[0].metrics[2].verdict, Verdict::kNoDifferenceSeen);
  EXPECT_THAT(c.notes, ElementsAre(HasSubstr("/algorithms/yoon2021/stamps: 100 against 50"),
                                   HasSubstr("seeds 1-32 against 11-42: the common ones, 11-32"),
                                   "version 1.2.3 against 1.3.0", "commit abc against def",
                                   HasSubstr("only in a, not compared: plain"),
                                   HasSubstr("only in b, not compared: other")));
}

TEST(CompareArchives, AnotherWorldIsRefusedUnlessAskedFor) {
  const Archive a = sample_archive("a");
  Archive b = sample_archive("b");
  replace(b.scenario_json, "0.1", "0.25");
  EXPECT_THAT([&] { compare_archives(a, b, {}); },
              ThrowsMessage<InputError>(
                  AllOf(HasSubstr("/network/latency_fixed_ms: 0.1 against 0.25"),
                        HasSubstr("--different-scenarios"), HasSubstr("--with-baseline"))));
  const Comparison c = compare_archives(a, b, {.different_scenarios = true});
  EXPECT_THAT(c.notes, ElementsAre(HasSubstr("different worlds (--different-scenarios)")));
}

TEST(CompareArchives, WithoutManifestsOnlyTheNamesCanBeChecked) {
  const Archive a = sample_archive("a");
  Archive b = sample_archive("b");
  b.scenario_json.clear();
  EXPECT_THAT(compare_archives(a, b, {}).notes, ElementsAre(HasSubstr("not checked")));
  b.results.scenario = "other";
  EXPECT_THAT([&] { compare_archives(a, b, {}); },
              ThrowsMessage<InputError>(HasSubstr("scenario sample against other")));
  EXPECT_EQ(compare_archives(a, b, {.different_scenarios = true}).pipelines.size(), 2U);
}

TEST(CompareArchives, WithoutCommonSeedsTheIndexIsOffered) {
  const Archive a = sample_archive("a", 1, 32);
  const Archive b = sample_archive("b", 33, 40);
  EXPECT_THAT([&] { compare_archives(a, b, {}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("a has the seeds 1-32 and b has 33-72"),
                                              HasSubstr("--by-index"))));
  const Comparison c = compare_archives(a, b, {.by_index = true});
  EXPECT_EQ(c.seed_count, 32U);
  EXPECT_EQ(c.first_seed_b, 33U);
  EXPECT_THAT(plain(comparison_document(c)), HasSubstr("32 pairs by index: seeds 1-32 with 33-64"));
}

TEST(CompareArchives, WithoutCommonPipelinesThereIsNothingToCompare) {
  const Archive a = sample_archive("a");
  Archive b = sample_archive("b");
  for (evaluation::Row& row : b.results.rows) row.pipeline += "_b";
  EXPECT_THAT([&] { compare_archives(a, b, {}); },
              ThrowsMessage<InputError>(
                  AllOf(HasSubstr("no pipeline is in both"), HasSubstr("plain_b, good_b"))));
  EXPECT_THAT([&] { compare_archives(a, b, {.pipelines = {"good"}}); },
              ThrowsMessage<InputError>(HasSubstr("'good', which b does not have")));
}

TEST(ComparePipelines, BIsHeldAgainstA) {
  const Comparison c = compare_pipelines(sample_archive("a"), "plain", "good", {});
  ASSERT_EQ(c.pipelines.size(), 1U);
  EXPECT_NEAR(c.pipelines[0].metrics[0].ratio.value, 0.2, 1e-12);
  EXPECT_EQ(c.pipelines[0].metrics[0].verdict, Verdict::kBetter);
  EXPECT_THAT([] { compare_pipelines(sample_archive("a"), "plain", "godo", {}); },
              ThrowsMessage<InputError>(HasSubstr("it has plain, good")));
}

TEST(ComparePipelines, LoadsOfTheirOwnAreSaid) {
  Archive a = sample_archive("a");
  a.results.draws_load = true;
  const auto says_so = ElementsAre(HasSubstr("drawn for each pipeline on its own"));
  EXPECT_THAT(compare_pipelines(a, "plain", "good", {}).notes, says_so);
  EXPECT_THAT(compare_with_baseline(a, "plain", {}).notes, says_so);
  EXPECT_THAT(compare_archives(a, a, {}).notes, IsEmpty()) << "one pipeline has one load in a seed";
  Archive b = a;
  b.results.scenario = "other";
  replace(b.scenario_json, "\"name\": \"", "\"name\": \"other");
  EXPECT_THAT(compare_archives(a, b, {.different_scenarios = true}).notes,
              Contains(HasSubstr("drawn for each pipeline on its own")));
}

TEST(CompareWithBaseline, SaysHowMuchBetterInPlainWords) {
  const Comparison c = compare_with_baseline(sample_archive("a"), "plain", {});
  EXPECT_THAT(
      plain(comparison_document(c)),
      AllOf(HasSubstr("good against plain: AMD 5.00 times smaller [5.00, 5.00]; RMDV 5.00 times"),
            HasSubstr("5.00]; recall: no difference")));
  EXPECT_THAT([] { compare_with_baseline(sample_archive("a"), "ntp", {}); },
              ThrowsMessage<InputError>(HasSubstr("--with-baseline: found 'ntp'")));
}

TEST(EffectWords, ChooseTheFormThatReadsBest) {
  const evaluation::Metric& amd = evaluation::metric("amd_ms");
  const auto words = [&](double factor) {
    evaluation::PairedValues values;
    for (int i = 0; i < 32; ++i) values.pairs.push_back({10, 10 * factor});
    const auto all = evaluation::compare_together({{.values = values, .rule = {}}});
    return effect_words(amd, all.front(), 0.05);
  };
  EXPECT_EQ(words(250), "AMD 250 times larger [250, 250]");
  EXPECT_EQ(words(1.5), "AMD 50.0 % larger [50.0 %, 50.0 %]");
  EXPECT_EQ(words(0.75), "AMD 25.0 % smaller [25.0 %, 25.0 %]");
  EXPECT_EQ(words(0.001), "AMD 1000 times smaller [1000, 1000]");
  EXPECT_EQ(words(1), "AMD: no difference seen: all equal");
  const auto few = evaluation::compare_together(
      {{.values = evaluation::pair_up({10, 10, 10}, {2000, 1000, 3000}), .rule = {}}});
  EXPECT_EQ(effect_words(amd, few.front(), 0.05),
            "AMD: 200 times larger, but too few seeds: 6 needed, higher in 3 of 3");
}

TEST(VerdictText, SaysWhatIsMissing) {
  EXPECT_EQ(verdict_text({}, 0.05), "no values");
  evaluation::PairedComparison c;
  c.pairs = 1;
  c.lower = 1;
  EXPECT_EQ(verdict_text(c, 0.05), "too few seeds: more needed, lower in 1 of 1");
  c.pairs = 5;
  c.higher = 4;
  c.seeds_needed = 9;
  EXPECT_EQ(verdict_text(c, 0.05), "too few seeds: 9 needed, higher in 4 of 5");
  c.difference = {.value = 1, .low = -1, .high = 3};
  c.seeds_needed = 120;
  c.left_out = 2;
  EXPECT_EQ(verdict_text(c, 0.05), "too few seeds: 120 needed (2 seeds left out: no value)");
  c.seeds_needed = 5'000'000;
  c.left_out = 0;
  EXPECT_EQ(verdict_text(c, 0.05), "too few seeds: over a million needed");
}

TEST(CountVerdicts, CountsWhatIsTested) {
  const VerdictCount same =
      count_verdicts(compare_archives(sample_archive("a"), sample_archive("b"), {}));
  EXPECT_EQ(same.tests, 0U);
  EXPECT_GT(same.equal, 0U);
  EXPECT_EQ(same.expected_false(), 0);
  Archive b = sample_archive("b");
  scale(b.results.rows[1].amd_ms, 0.5);
  const Comparison c = compare_archives(sample_archive("a"), b, {});
  EXPECT_EQ(count_verdicts(c).tests, 1U);
  EXPECT_EQ(count_verdicts(c).fewest_pairs, 6U);
  EXPECT_THAT(plain(comparison_document(c)),
              AllOf(HasSubstr("1 verdict made together, with Holm's"),
                    HasSubstr("false ones if nothing differs: about 0.05")));
  const Json verdicts = Json::parse(comparison_json(c))["verdicts"];
  EXPECT_EQ(verdicts["together"], 1);
  EXPECT_EQ(verdicts["equal"], same.equal - 1);
}

TEST(ComparisonOutput, OfAFewSeedsSaysWhatTheyCanTell) {
  const std::string text =
      plain(comparison_document(compare_with_baseline(sample_archive("a", 1, 5), "plain", {})));
  EXPECT_THAT(text, AllOf(HasSubstr("lower in 5 of 5"), HasSubstr("no p-value can be below 0.0625"),
                          HasSubstr("show neither better nor worse"), Not(HasSubstr("million"))));
}

TEST(ComparisonOutput, JsonHasNullWhereThereIsNothing) {
  Archive b = sample_archive("b");
  b.results.rows[0].amd_ms.values.assign(32, std::numeric_limits<double>::quiet_NaN());
  const Comparison c = compare_archives(sample_archive("a"), b, {});
  const Json root = Json::parse(comparison_json(c));
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["pipelines"][0]["amd_ms"]["left_out"], 32);
  EXPECT_TRUE(root["pipelines"][0]["amd_ms"]["difference"]["low"].is_null());
  EXPECT_EQ(root["pipelines"][1]["amd_ms"]["verdict"], "no_difference_seen");
  EXPECT_TRUE(root["pipelines"][1]["amd_ms"]["seeds_needed"].is_null());
  EXPECT_THAT(plain(comparison_document(c)), AllOf(HasSubstr("no values"), Not(HasSubstr("nan"))));
  EXPECT_THAT(comparison_csv(c),
              AllOf(HasSubstr("plain,plain,amd_ms,0,32,,,"), Not(HasSubstr("nan"))));
}

TEST(ComparisonOutput, CsvHasALinePerPipelineAndMetric) {
  const std::string csv = comparison_csv(compare_with_baseline(sample_archive("a"), "plain", {}));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, HasSubstr("\nplain,good,seed_recall,32,0,1,1,1,1,0,0,0,1,1,1,"));
}

TEST(ComparisonOutput, CsvQuotesNamesOfPipelines) {
  Archive a = sample_archive("a");
  a.results.rows[1].pipeline = "good, indeed";
  EXPECT_THAT(comparison_csv(compare_with_baseline(a, "plain", {})),
              HasSubstr("\nplain,\"good, indeed\",amd_ms,32,"));
  EXPECT_THAT(comparison_csv(compare_with_baseline(a, "good, indeed", {})),
              HasSubstr("\n\"good, indeed\",plain,amd_ms,32,"));
}

TEST(ComparisonOutput, MarkdownIsATableWithItsNotes) {
  Archive b = sample_archive("b");
  b.version = "2";
  EXPECT_THAT(markdown(comparison_document(compare_archives(sample_archive("a"), b, {}))),
              AllOf(HasSubstr("| plain"), HasSubstr("- version 1.2.3 against 2\n")));
}

}  // namespace
}  // namespace simbench::reports
