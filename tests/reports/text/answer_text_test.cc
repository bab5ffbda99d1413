#include "reports/text/answer_text.h"

#include <gmock/gmock.h>

#include "reports/text/answer_json.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

AnswerText short_answer() {
  AnswerText answer{.lead = "a < b is best."};
  answer.add("Others", "The next has twice as much.");
  answer.add("Limit", "");
  answer.add("Uncertain", "1 seed.");
  return answer;
}

TEST(AnswerText, FewSeedsAgreeWithTheirVerb) {
  EXPECT_EQ(few_seeds_text(1), "1 seed says little about other worlds");
  EXPECT_EQ(few_seeds_text(3), "3 seeds say little about other worlds");
  EXPECT_EQ(few_seeds_text(1, " of a point"), "1 seed of a point says little about other worlds");
}

TEST(AnswerText, IsALeadAndLabelledLines) {
  EXPECT_THAT(
      paragraphs(short_answer()),
      ElementsAre("a < b is best.", "Others: The next has twice as much.", "Uncertain: 1 seed."));
}

TEST(AnswerText, ForProgramsHasTheSameParts) {
  const Json json = answer_json(short_answer());
  EXPECT_EQ(json["lead"], "a < b is best.");
  ASSERT_EQ(json["lines"].size(), 2U);
  EXPECT_EQ(json["lines"][1], (Json{{"label", "Uncertain"}, {"text", "1 seed."}}));
  EXPECT_TRUE(answer_json({}).is_null());
}

TEST(AnswerText, IsALeadAndLabelledLinesOnAPage) {
  const std::string page = html(short_answer());
  EXPECT_THAT(page, HasSubstr("<p>a &lt; b is best.</p>"));
  EXPECT_THAT(page, HasSubstr("<dt>Others</dt><dd>The next has twice as much.</dd>"));
  EXPECT_THAT(page, Not(HasSubstr("Limit")));
}

TEST(AnswerText, WithoutALeadThereIsNone) {
  EXPECT_THAT(paragraphs({}), IsEmpty());
  EXPECT_EQ(html(AnswerText{}), "");
}

}  // namespace
}  // namespace simbench::reports
