#include "reports/page/overview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using evaluation::RankedBy;
using testing::HasSubstr;

TEST(Overview, HasARowPerPipelineInOrder) {
  const std::string html = overview_html(sample_results(), RankedBy::kAmd);
  const std::size_t best = html.find("yoon2021_<wbr>both <small>best</small>");
  const std::size_t other = html.find("free_<wbr>running");
  ASSERT_NE(best, std::string::npos) << html;
  ASSERT_NE(other, std::string::npos) << html;
  EXPECT_LT(best, other);
  EXPECT_THAT(html, HasSubstr("title=\"published: 2.44 ms\""));
  EXPECT_THAT(html, HasSubstr("1 ms</span>"));
}

TEST(Overview, EscapesNames) {
  evaluation::Results results = sample_results();
  results.rows.front().pipeline = "<b>&";
  EXPECT_THAT(overview_html(results, RankedBy::kAmd), HasSubstr("&lt;b&gt;&amp;"));
}

TEST(Overview, IsNothingWithoutValues) { EXPECT_EQ(overview_html({}, RankedBy::kAmd), ""); }

}  // namespace
}  // namespace simbench::reports
