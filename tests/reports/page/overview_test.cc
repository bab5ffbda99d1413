#include "reports/page/overview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tests/nonempty.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;

TEST(Overview, HasARowPerPipelineInOrder) {
  evaluation::Results results = sample_results();
  results.rows[0].unsynchronised_hosts = 0;
  const std::string html = overview_html(results);
  const std::size_t best = html.find("yoon2021_<wbr>both <small>best</small>");
  const std::size_t other = html.find("free_<wbr>running <small>failed</small>");
  ASSERT_NE(best, std::string::npos) << html;
  ASSERT_NE(other, std::string::npos) << html;
  EXPECT_LT(best, other);
  EXPECT_THAT(html, HasSubstr("title=\"published: 2.44 ms\""));
  EXPECT_THAT(html, HasSubstr("1 ms</span>"));
}

TEST(Overview, ABoundOfTheRankedMetricIsADiamond) {
  evaluation::Results results = sample_figure_results();
  for (evaluation::Row& row : results.rows) row.published.reset();
  const std::vector<OverviewRow> rows = overview_rows(results);
  const auto published = [&rows](const std::string& pipeline) {
    const auto found =
        std::ranges::find(rows, pipeline, [](const OverviewRow& row) { return row.row->pipeline; });
    return found == rows.end() ? std::nullopt : found->published_ms;
  };
  EXPECT_EQ(published("yoon2021_both"), 2.44);
  EXPECT_EQ(published("oracle"), std::nullopt);
  EXPECT_THAT(overview_html(results), HasSubstr("Diamonds"));
  results.ranked_by = evaluation::RankedBy::kAbsoluteError;
  for (const OverviewRow& row : nonempty(overview_rows(results))) {
    EXPECT_FALSE(row.published_ms.has_value());
  }
}

TEST(Overview, EscapesNames) {
  evaluation::Results results = sample_results();
  results.rows.front().pipeline = "<b>&";
  EXPECT_THAT(overview_html(results), HasSubstr("&lt;b&gt;&amp;"));
}

TEST(Overview, IsNothingWithoutValues) { EXPECT_EQ(overview_html({}), ""); }

}  // namespace
}  // namespace simbench::reports
