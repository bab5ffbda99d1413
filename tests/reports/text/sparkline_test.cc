#include "reports/text/sparkline.h"

#include <gmock/gmock.h>

#include <cmath>

#include "evaluation/statistics/statistics.h"
#include "reports/text/block.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Sparkline, ADistributionHasAStrokeForEachValueOnItsOwnScale) {
  const std::string picture = svg(seeds_sparkline(evaluation::make_series({3, 1, NAN, 2})));
  // One pixel of margin in 72: 1, 2 and 3 ms stand at 1, 36 and 71.
  EXPECT_THAT(picture, HasSubstr("d=\"M1.0 4V12M36.0 4V12M71.0 4V12\""));
  EXPECT_THAT(picture, HasSubstr("class=\"median\" d=\"M36.0 1V15\""));
}

TEST(Sparkline, SaysTheSameInWords) {
  EXPECT_THAT(svg(seeds_sparkline(evaluation::make_series({3, 1, 2}))),
              HasSubstr("aria-label=\"3 seeds from 1.00 ms to 3.00 ms, median 2.00 ms\""));
}

TEST(Sparkline, ASeriesIsALineFromLeftToRight) {
  EXPECT_THAT(svg({.kind = Sparkline::Kind::kSeries, .values = {0, 4, 2}, .words = "a < b"}),
              testing::AllOf(HasSubstr("d=\"M1.0 15.0L36.0 1.0L71.0 8.0\""),
                             HasSubstr("<title>a &lt; b</title>")));
}

TEST(Sparkline, EqualValuesStandInTheMiddle) {
  EXPECT_THAT(svg({.values = {2, 2, 2}}), HasSubstr("M36.0 4V12M36.0 4V12"));
}

TEST(Sparkline, TwoValuesNeedNoPicture) {
  EXPECT_EQ(svg({.values = {1, 2}}), "");
  EXPECT_EQ(svg({.values = {1, NAN, NAN, INFINITY}}), "");
  EXPECT_EQ(svg(seeds_sparkline({})), "");
}

TEST(Sparkline, OnlyHtmlShowsIt) {
  const std::vector<Field<int>> fields = {
      {{"n"}, [](int n) { return std::to_string(n); }},
      {{"AMD"},
       [](int) { return std::string("1"); },
       [](int n) {
         return Sparkline{.values = {0, 1, static_cast<double>(n)}, .words = "the seeds"};
       }}};
  const Table table = table_of(fields, std::vector<int>{2, 3});
  const std::string page = html(table, "a table");
  EXPECT_THAT(page, HasSubstr("<td>1<svg class=\"spark\""));
  EXPECT_NE(page.find("<svg"), page.rfind("<svg")) << "one for each row";
  const Document document{.blocks = {{.table = table}}};
  for (const std::string& text : {plain(document), markdown(document), latex(document)}) {
    EXPECT_THAT(text, Not(HasSubstr("svg")));
    EXPECT_THAT(text, Not(HasSubstr("the seeds")));
  }
}

}  // namespace
}  // namespace simbench::reports
