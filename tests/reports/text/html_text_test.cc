// Text in HTML: nothing that comes from outside may become markup or script.
#include "reports/text/html_text.h"

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

TEST(HtmlTable, HasItsCellsAsText) {
  HtmlTable table("A <caption>", {{"name", HtmlTable::Align::kLeft}, {"AMD, ms"}});
  EXPECT_TRUE(table.empty());
  table.add({"<b>", "1.500"});
  EXPECT_FALSE(table.empty());
  const std::string html = table.html();
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\" class=\"text\">&lt;b&gt;</th><td>1.500</td>"));
  EXPECT_THAT(html, HasSubstr("<caption>A &lt;caption&gt;</caption>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">AMD, ms</th>"));
}

}  // namespace
}  // namespace simbench::reports
