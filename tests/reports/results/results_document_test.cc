// The whole table, as a newcomer sees it.
#include "reports/results/results_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "evaluation/scoring/metrics.h"
#include "reports/results/metric_columns.h"
#include "reports/text/number_text.h"
#include "reports/text/plain_text.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string table(const evaluation::Results& results, const std::string& summary) {
  return plain(results_document(results, summary));
}

TEST(Table, PlainText) {
  EXPECT_EQ(table(sample_results(), "A fit, stated as such."), R"(sample: 2 seeds (1-2)
A fit, stated as such.

The paper's metrics

                   AMD              AMD  published  published    at percentile      RMDV              RMDV  published  published
pipeline        median           5-95 %        AMD  AMD is     [95 % interval]    median            5-95 %       RMDV  RMDV is
-------------  -------  ---------------  ---------  ---------  ---------------  --------  ----------------  ---------  --------------
yoon2021_both  2.00 ms  [1.50, 2.50] ms    2.44 ms  inside        50 % [32-68]  0.750 ms  [0.500, 1.00] ms    1.80 ms  not attainable
free_running     750 s  [0.500, 1500] s          -  -                        -    250 ms     [200, 300] ms          -  -

Published AMD, by its percentile [95 % interval]: 1 of 1 inside (yoon2021_both at 50 % [32-68]).

Metrics that need true time

               absolute error   absolute error            host clock error   host clock error  exposure      sets:   sets:            frames  pulses
pipeline               median           5-95 %      bias            median             5-95 %    spread  precision  recall   margin  dropped  scored
-------------  --------------  ---------------  --------  ----------------  -----------------  --------  ---------  ------  -------  -------  ------
yoon2021_both         29.0 ms  [28.0, 30.0] ms  -29.0 ms          0.500 ms  [0.250, 0.750] ms   62.5 us      100 %  75.0 %  8.50 ms        3     960
free_running                -                -         -                 -                  -         -          -     0 %        -        0       0

Time error of the hosts

                                   constant  dynamic  packets
pipeline       max |TE|    RMS TE        TE       TE    per s
-------------  --------  --------  --------  -------  -------
yoon2021_both   1.50 ms  0.625 ms  0.375 ms  2.00 ms     30.0
free_running          -         -         -        -        -

yoon2021_both: host synchronisation failed once over all seeds. Seed 2: timeout.

How to read it
  Every pipeline meets the same worlds, one per seed. A value is the median over the seeds, [a, b] their band from 5 to 95 %.
  AMD: mean range of the global stamps of a pulse over all cameras; RMDV: mean RMS deviation of these from their median.
  absolute error: mean |global stamp - true mid-exposure on the master's clock|; bias: the signed mean, which AMD cannot show.
  host clock error: mean |slave - master|. exposure spread: how far apart the exposures really were, a limit for AMD.
  precision: gathered sets that hold one pulse only; recall: complete pulses found whole; margin: limit less 99.9 % quantile of the range.
  TE: a host's clock minus the master's, over all slaves; constant: largest mean of a host; dynamic: largest range of a host.
  packets: messages that all hosts sent, the lost ones too, from the start of host synchronisation to the end of the capture.
  published: the paper's one recording. inside: the whole interval of its percentile lies from 5 to 95 %; outside: all of it lies beyond;
  too few seeds: neither (outside takes 72 seeds). not attainable: under eq. (4) no data have that RMDV with that AMD.

Pipelines = host_sync + device_time + gathering
  yoon2021_both = yoon2021_both + regression_30 + yoon2021
  free_running = free_running + raw_arrival + yoon2021

The paper's claims, and the fraction of seeds in which each holds

claim  holds in  of the paper
-----  --------  ----------------------------------------------------
C1       50.0 %  none is worst
C4            -  lower at 45 than at 15 FPS (needs 18cam_6host_15fps)

Cost: 1.23 M events in 0.25 s (0.50 s of CPU): 4.94 M events/s, 256 simulated seconds per second.
)");
}

TEST(Table, TimeErrorsAreOfSlavesWithTrueTimeOnly) {
  evaluation::Results results = sample_results();
  evaluation::Row& both = results.rows[0];
  both.max_te_ms = both.rms_te_ms = both.constant_te_ms = both.dynamic_te_ms = both.packets_per_s =
      no_series();
  EXPECT_THAT(table(results, ""), Not(HasSubstr("TE")));
}

TEST(Table, GatheringHasABlockOnlyIfThePipelinesDiffer) {
  EXPECT_THAT(table(sample_results(), ""), Not(HasSubstr("Gathered sets")));
  evaluation::Results results = sample_results();
  results.rows[1].gathering = "epsilon";
  EXPECT_THAT(table(results, ""), HasSubstr(
                                      R"(Gathered sets, over all seeds

                          complete      sets:   sets:   index  partial     frames   AMD of  abs. error  emitted after  emitted after
pipeline       gathering      sets  precision  recall  errors     sets  discarded     sets     of sets           mean        largest
-------------  ---------  --------  ---------  ------  ------  -------  ---------  -------  ----------  -------------  -------------
yoon2021_both  yoon2021        720      100 %  75.0 %       0        4         21  1.75 ms     28.0 ms       0.250 ms        6.00 ms
free_running   epsilon           0          -     0 %       0        0          0        -           -              -              -
)"));
}

TEST(Table, Markdown) {
  EXPECT_EQ(markdown(results_document(sample_results(), "A fit, stated as such.")),
            R"(## sample: 2 seeds (1-2)

A fit, stated as such.

### The paper's metrics

| pipeline | AMD median | AMD 5-95 % | published AMD | published AMD is | at percentile [95 % interval] | RMDV median | RMDV 5-95 % | published RMDV | published RMDV is |
|---|---:|---:|---:|---|---:|---:|---:|---:|---|
| yoon2021_both | 2.00 ms | [1.50, 2.50] ms | 2.44 ms | inside | 50 % [32-68] | 0.750 ms | [0.500, 1.00] ms | 1.80 ms | not attainable |
| free_running | 750 s | [0.500, 1500] s | - | - | - | 250 ms | [200, 300] ms | - | - |

Published AMD, by its percentile [95 % interval]: 1 of 1 inside (yoon2021_both at 50 % [32-68]).

### Metrics that need true time

| pipeline | absolute error median | absolute error 5-95 % | bias | host clock error median | host clock error 5-95 % | exposure spread | sets: precision | sets: recall | margin | frames dropped | pulses scored |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|
| yoon2021_both | 29.0 ms | [28.0, 30.0] ms | -29.0 ms | 0.500 ms | [0.250, 0.750] ms | 62.5 us | 100 % | 75.0 % | 8.50 ms | 3 | 960 |
| free_running | - | - | - | - | - | - | - | 0 % | - | 0 | 0 |

### Time error of the hosts

| pipeline | max \|TE\| | RMS TE | constant TE | dynamic TE | packets per s |
|---|---:|---:|---:|---:|---:|
| yoon2021_both | 1.50 ms | 0.625 ms | 0.375 ms | 2.00 ms | 30.0 |
| free_running | - | - | - | - | - |

yoon2021_both: host synchronisation failed once over all seeds. Seed 2: timeout.

### How to read it

- Every pipeline meets the same worlds, one per seed. A value is the median over the seeds, [a, b] their band from 5 to 95 %.
- AMD: mean range of the global stamps of a pulse over all cameras; RMDV: mean RMS deviation of these from their median.
- absolute error: mean |global stamp - true mid-exposure on the master's clock|; bias: the signed mean, which AMD cannot show.
- host clock error: mean |slave - master|. exposure spread: how far apart the exposures really were, a limit for AMD.
- precision: gathered sets that hold one pulse only; recall: complete pulses found whole; margin: limit less 99.9 % quantile of the range.
- TE: a host's clock minus the master's, over all slaves; constant: largest mean of a host; dynamic: largest range of a host.
- packets: messages that all hosts sent, the lost ones too, from the start of host synchronisation to the end of the capture.
- published: the paper's one recording. inside: the whole interval of its percentile lies from 5 to 95 %; outside: all of it lies beyond; too few seeds: neither (outside takes 72 seeds). not attainable: under eq. (4) no data have that RMDV with that AMD.

### Pipelines = host_sync + device_time + gathering

- yoon2021_both = yoon2021_both + regression_30 + yoon2021
- free_running = free_running + raw_arrival + yoon2021

### The paper's claims, and the fraction of seeds in which each holds

| claim | holds in | of the paper |
|---|---:|---|
| C1 | 50.0 % | none is worst |
| C4 | - | lower at 45 than at 15 FPS (needs 18cam_6host_15fps) |

Cost: 1.23 M events in 0.25 s (0.50 s of CPU): 4.94 M events/s, 256 simulated seconds per second.
)");
}

TEST(ResultsDocument, AMetricThatNamesItsTableStandsInIt) {
  evaluation::Metric mine = evaluation::metric("bias_ms");
  mine.id = "mine_ms";
  const evaluation::ScopedMetric scoped(mine);
  const ScopedMetricColumn column({.id = "mine_ms",
                                   .tables = {.truth = 10},
                                   .heading = "mine",
                                   .legend = "mine: of this test."});
  const Document document = results_document(sample_results(), "");
  EXPECT_THAT(plain(document), HasSubstr("  -29.0 ms\n"));  // in the last column
  EXPECT_THAT(plain(document), HasSubstr("\n  mine: of this test.\n"));
  EXPECT_THAT(markdown(document), HasSubstr("| pulses scored | mine |\n"));
  EXPECT_THAT(html(document.blocks), HasSubstr("title=\"mine: of this test.\">mine</th></tr>"));
}

TEST(Table, SaysOverHowManySeedsAMedianIs) {
  EXPECT_THAT(table(sample_results(), ""), Not(HasSubstr("seeds  ")));
  evaluation::Results results = sample_results();
  results.rows[0].amd_ms.values = {1.5, kNaN};
  results.rows[0].rmdv_ms.values = {0.5, kNaN};
  results.rows[0].absolute_error_ms.values = {28, kNaN};
  const std::string text = table(results, "");
  EXPECT_THAT(text, testing::ContainsRegex("pipeline +seeds "));
  EXPECT_THAT(text, testing::ContainsRegex("yoon2021_both +1 of 2 +2.00 ms"));
  EXPECT_THAT(text, testing::ContainsRegex("yoon2021_both +1-2 of 2 +29.0 ms"));
  EXPECT_THAT(text, testing::ContainsRegex("free_running +2 of 2 "));
  EXPECT_THAT(text, HasSubstr(kScoredSeedsLegend));
  const Document document = results_document(results, "");
  EXPECT_THAT(markdown(document), HasSubstr("| yoon2021_both | 1 of 2 | 2.00 ms |"));
  EXPECT_THAT(html(document.blocks), HasSubstr("<td>1 of 2</td><td>2.00 ms</td>"));
}

TEST(Table, APipelineWithoutAnySeedSaysSo) {
  evaluation::Results results = sample_results();
  evaluation::Row& lost = results.rows[1];
  lost.amd_ms = lost.rmdv_ms = lost.seed_recall = no_series();
  EXPECT_THAT(table(results, ""), testing::ContainsRegex("free_running +0 of 2 +- "));
}

TEST(Table, AClaimSaysInHowManySeedsItWasDecided) {
  evaluation::Results results = sample_results();
  results.claims[0].decided_seeds = 1;
  EXPECT_THAT(table(results, ""), HasSubstr("50.0 % of 1 seed  none is worst"));
}

TEST(ResultsDocument, ClaimsOfThePaperAreNotThoseOfAnotherWorld) {
  evaluation::Results results = sample_results();
  const auto heading = [&results] {
    const std::string text = plain(results_document(results, ""));
    const std::size_t at = text.find("The paper's claims");
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(heading(), "The paper's claims, and the fraction of seeds in which each holds");
  results.derivation = {
      .base = "sample", .changes = {{"/a", "1", "2"}}, .unpublished = "18cam_6host_45fps"};
  EXPECT_EQ(
      heading(),
      "The paper's claims about its own rig, not this one, and the fraction of seeds in which "
      "each holds");
}

TEST(ResultsDocument, SteeredExposuresHaveABlock) {
  evaluation::Results results = sample_results();
  const std::string unsteered = plain(results_document(results, ""));
  EXPECT_THAT(unsteered, Not(HasSubstr("Alignment of the exposures")));
  EXPECT_THAT(unsteered, Not(HasSubstr("wrong locks")));
  set_steered(results.rows[0]);
  const std::string text = markdown(results_document(results, ""));
  EXPECT_THAT(text, HasSubstr("### Alignment of the exposures"));
  EXPECT_THAT(text, HasSubstr("| yoon2021_both | 0.500 ms | 2.00 ms | 3.00 s | 8.00 s | - | 12.5 | "
                              "5.00 ppm | 0.500 |"));
  results.rows[0].aligned_0_1_ms_s = {.values = {6, kNaN}, .median = 6, .p05 = 6, .p95 = 6};
  EXPECT_THAT(markdown(results_document(results, "")), HasSubstr("| 2.00 ms | 3.00 s | - | - |"))
      << "half of the seeds never were";
  EXPECT_THAT(text, HasSubstr("wrong locks: cameras reported as aligned"));
  EXPECT_THAT(text,
              HasSubstr("Pipelines = host_sync [+ capture_alignment] + device_time + gathering"));
  EXPECT_THAT(text,
              HasSubstr("yoon2021_both = yoon2021_both + nudge + regression_30 + yoon2021\n"));
  EXPECT_THAT(text, HasSubstr("free_running = free_running + raw_arrival + yoon2021\n"));
}

TEST(ResultsDocument, SessionsHaveABlockOfTheirRows) {
  evaluation::Results results = sample_results();
  EXPECT_THAT(plain(results_document(results, "")), Not(HasSubstr("Delays of the sessions")));
  set_sessions(results.rows[0]);
  const std::string text = plain(results_document(results, ""));
  EXPECT_THAT(text, HasSubstr(R"(Delays of the sessions of Algorithms 1 and 2

                   t_l              t_l      t_t              t_t      t_d
pipeline        median           5-95 %   median           5-95 %   median      get      set  message  passes
-------------  -------  ---------------  -------  ---------------  -------  -------  -------  -------  ------
yoon2021_both  3.50 ms  [3.00, 4.00] ms  2.25 ms  [2.00, 2.50] ms  5.75 ms  1.00 us  4.50 ms  4.00 ms    1.50

)"));
  EXPECT_THAT(text, HasSubstr("t_l, t_t: network and time delay as the slaves measured them"));
}

// Beside AMD where captures were certified; a seed that nothing bounds is not passed over silently.
TEST(Table, CertificatesStandBesideAmdWithTheirSeeds) {
  evaluation::Results results = sample_results();
  EXPECT_THAT(table(results, ""), Not(HasSubstr("certified")));
  results.rows[0].certified_ms = series(2, 3);
  const std::string whole = table(results, "");
  EXPECT_THAT(whole, HasSubstr("certified: no two frames of 95 % of the sets"));
  EXPECT_THAT(whole, HasSubstr("2.50 ms"));
  EXPECT_THAT(whole, Not(HasSubstr("1-2 of 2")));
  results.rows[0].certified_ms = {.values = {2, kNaN}, .median = 2, .p05 = 2, .p95 = 2};
  EXPECT_THAT(table(results, ""), HasSubstr("1-2 of 2"));
  EXPECT_THAT(table(results, ""), HasSubstr(kScoredSeedsLegend));
}

TEST(Table, WithoutPublishedValuesHasNoColumnsForThem) {
  evaluation::Results results = sample_results();
  results.rows[0].published.reset();
  results.claims.clear();
  const std::string text = table(results, "");
  EXPECT_THAT(text, Not(HasSubstr("published")));
  EXPECT_THAT(text, Not(HasSubstr("claim")));
}

TEST(Table, AVerdictForEveryPublishedValue) {
  evaluation::Results results = sample_results();
  results.rows[0].published->amd_percentile = {0, 0, 4.75};
  results.rows[0].published->rmdv_attainable = true;
  EXPECT_THAT(table(results, ""), Not(HasSubstr("2.44 ms  inside")));
  EXPECT_THAT(table(results, ""), HasSubstr("2.44 ms  outside"));
  EXPECT_THAT(table(results, ""), HasSubstr("1.80 ms  outside"));
  results.rows[0].published->rmdv_percentile = {50, 32.25, 67.75};
  EXPECT_THAT(table(results, ""), HasSubstr("1.80 ms  inside"));
  results.rows[0].published->rmdv_percentile = {50, 1.25, 98.75};
  EXPECT_THAT(table(results, ""), HasSubstr("1.80 ms  too few seeds"));
}

TEST(Table, FitsAWideTerminal) {
  std::istringstream lines(table(sample_results(), "A summary " + std::string(300, '.')));
  std::string line;
  while (std::getline(lines, line)) {
    const bool one_word = line.find("....") != std::string::npos;
    EXPECT_TRUE(one_word || line.size() <= 150) << line;
  }
}

TEST(Wrapped, BreaksBetweenWords) {
  EXPECT_EQ(wrapped(""), "");
  EXPECT_EQ(wrapped("one two", 2), "  one two\n");
  const std::string word(50, 'x');
  EXPECT_EQ(wrapped(word + " " + word + " " + word, 1),
            " " + word + " " + word + "\n " + word + "\n");
  const std::string endless(kTextWidth + 10, 'y');
  EXPECT_EQ(wrapped("a " + endless + " b"), "a\n" + endless + "\nb\n");
}

}  // namespace
}  // namespace simbench::reports
