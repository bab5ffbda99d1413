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

}  // namespace
}  // namespace simbench::reports
