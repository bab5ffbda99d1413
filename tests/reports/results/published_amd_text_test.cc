#include <gtest/gtest.h>

#include "evaluation/scoring/rows.h"
#include "reports/results/results_document.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

// `below` of `all` seeds have an AMD below the published one.
evaluation::Row placed_row(const char* pipeline, int below, int all) {
  evaluation::Row row;
  row.pipeline = pipeline;
  for (int i = 0; i < all; ++i) row.amd_ms.values.push_back(i < below ? 1 : 3);
  row.published = evaluation::compare({.amd_ms = 2, .rmdv_ms = 1}, row, {.sources = 18});
  return row;
}

// Exact binomial intervals: 200 of 400 seeds give 45.0 to 55.0 %, 392 of 400 give 96.1 to 99.1 %,
// 384 of 400 give 93.6 to 97.7 %.
TEST(PublishedAmdText, FollowsFromThePercentilesOfTheSeeds) {
  evaluation::Results results;
  results.seed_count = 400;
  results.rows = {placed_row("middle", 200, 400), placed_row("above", 392, 400)};
  EXPECT_EQ(published_amd_text(results),
            "Published AMD, by its percentile [95 % interval]: 1 of 2 inside (middle at 50 % "
            "[45-55]); outside: above at 98 % [96-99].");
  results.rows.push_back(placed_row("border", 384, 400));
  EXPECT_EQ(published_amd_text(results),
            "Published AMD, by its percentile [95 % interval]: 1 of 3 inside (middle at 50 % "
            "[45-55]); outside: above at 98 % [96-99]; 400 seeds cannot place border at 96 % "
            "[94-98].");
  const PublishedAmdCount count = published_amd_count(results);
  EXPECT_EQ(count.all, 3U);
  EXPECT_EQ(count.inside, 1U);
  EXPECT_EQ(count.outside, 1U);
}

TEST(PublishedAmdText, FewSeedsPlaceNothingBeyondTheirBand) {
  evaluation::Results results;
  results.seed_count = 32;
  results.rows = {placed_row("above", 32, 32)};
  EXPECT_EQ(published_amd_text(results),
            "Published AMD, by its percentile [95 % interval]: 0 of 1 inside; 32 seeds cannot "
            "place above at 100 % [89-100].");
}

TEST(PublishedAmdText, IsEmptyWithoutPublishedValues) {
  evaluation::Results results = sample_results();
  results.rows[0].published.reset();
  EXPECT_EQ(published_amd_text(results), "");
  EXPECT_EQ(published_amd_count(results).all, 0U);
}

}  // namespace
}  // namespace simbench::reports
