// Nothing that comes from outside may become markup or script.
#include "reports/text/escaped_text.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(HtmlText, EscapesWhatHtmlReads) {
  EXPECT_EQ(html_escaped("plain, 5-95 % µs"), "plain, 5-95 % µs");
  EXPECT_EQ(html_escaped("a < b && c > \"d\" or 'e'"),
            "a &lt; b &amp;&amp; c &gt; &quot;d&quot; or &#39;e&#39;");
}

TEST(HtmlText, AScriptCannotBeEndedByItsData) {
  const nlohmann::json data = {{"name", "</script><!--<script>"}, {"number", 1}};
  const std::string safe = script_safe(data.dump());
  EXPECT_THAT(safe, Not(HasSubstr("<")));
  EXPECT_EQ(nlohmann::json::parse(safe), data);
}

TEST(HtmlText, FillsATemplateOnce) {
  EXPECT_EQ(filled("a{{x}}b{{y}}{{x}}", {{"x", "1"}, {"y", "{{x}}"}}), "a1b{{x}}1");
  EXPECT_EQ(filled("no names", {}), "no names");
}

TEST(HtmlText, ANameWithoutAValueIsAProgrammingError) {
  EXPECT_DEATH(filled("{{missing}}", {}), "without a value");
}

TEST(LatexText, SpecialCharactersAreWrittenOut) {
  EXPECT_EQ(latex_escaped("5-95 %, a_b & $c #1 {d}"), "5-95 \\%, a\\_b \\& \\$c \\#1 \\{d\\}");
  EXPECT_EQ(latex_escaped("\\x1b"), "\\textbackslash{}x1b");
  EXPECT_EQ(latex_escaped("~^<>|"),
            "\\textasciitilde{}\\textasciicircum{}\\textless{}\\textgreater{}\\textbar{}");
  EXPECT_EQ(latex_escaped("45 → 30"), "45 $\\rightarrow$ 30");
  EXPECT_EQ(latex_escaped("Zürich"), "Zürich");
  EXPECT_EQ(latex_escaped(""), "");
}

TEST(HtmlText, HoldsNothingThatXmlCannotOrAReaderObeys) {
  EXPECT_EQ(html_escaped(std::string("a\x01z\n", 4)), "a\\x01z\n");
  EXPECT_EQ(html_escaped("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(html_escaped("a\u202eb\u2028c"), "a\\xe2\\x80\\xaeb\\xe2\\x80\\xa8c");
}

TEST(HtmlText, DataOfAScriptMeanTheSame) {
  const nlohmann::json data = {{"name", "a\u202eb\u0085c\x1b\x7f"}};
  const std::string safe = script_safe(data.dump());
  EXPECT_EQ(safe, R"({"name":"a\u202eb\u0085c\u001b\u007f"})");
  EXPECT_EQ(nlohmann::json::parse(safe), data);
}

}  // namespace
}  // namespace simbench::reports
