// The page as text; how it looks is tested in a browser (tests/browser/).
#include "reports/page/compare_page.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/reports/sample_archive.h"

namespace simbench::reports {
namespace {

const std::vector<std::string> kCompareLine = {"simbench", "compare", "monday", "tuesday"};

bool page_holds(const std::string& page, const std::string& part) {
  return page.find(part) != std::string::npos;
}

TEST(ComparePage, BeginsWithTheVerdictsAndHasTheTable) {
  const Archive archive = sample_archive("monday");
  const std::string page =
      compare_html(compare_with_baseline(archive, "plain", {}),
                   {"simbench", "compare", "monday", "--with-baseline", "plain"});
  const std::size_t answer = page.find("class=\"answer\"");
  const std::size_t figures =
      page.find("data-figures=\"compared_distributions paired_differences\"");
  const std::size_t table = page.find("<h3>Verdicts</h3>");
  EXPECT_LT(answer, figures);
  EXPECT_LT(figures, table);
  EXPECT_NE(table, std::string::npos);
  EXPECT_TRUE(page_holds(page, "<h2>monday: all against plain</h2>"));
  EXPECT_TRUE(page_holds(page, "B is better than A in"));
  EXPECT_TRUE(page_holds(page, "simbench compare monday --with-baseline plain"));
  EXPECT_TRUE(page_holds(page, "data-pipeline=\"good\""));
}

TEST(ComparePage, NamesBothSides) {
  const Archive a = sample_archive("monday");
  Archive b = sample_archive("tuesday");
  EXPECT_TRUE(page_holds(compare_html(compare_archives(a, b, {}), kCompareLine),
                         "<h2>tuesday against monday</h2>"));
  EXPECT_TRUE(page_holds(compare_html(compare_pipelines(a, "plain", "good", {}), kCompareLine),
                         "<h2>monday: good against plain</h2>"));
}

TEST(ComparePage, ShowsFirstThePipelineOfWhichSomethingIsSure) {
  const Archive a = sample_archive("monday");
  Archive b = sample_archive("tuesday");
  EXPECT_TRUE(page_holds(html_article(comparison_article(compare_archives(a, b, {}), kCompareLine)),
                         "data-pipeline=\"plain\""));
  scale(b.results.rows[1].amd_ms, 2);
  EXPECT_TRUE(page_holds(html_article(comparison_article(compare_archives(a, b, {}), kCompareLine)),
                         "data-pipeline=\"good\""));
}

TEST(ComparePage, NamesFromFilesAreText) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  Archive a = sample_archive(evil);
  a.results.rows[0].pipeline = evil;
  EXPECT_FALSE(page_holds(compare_html(compare_archives(a, a, {}), {evil}), "<img"));
}

}  // namespace
}  // namespace simbench::reports
