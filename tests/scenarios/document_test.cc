// Text that is broken, oversized or no JSON at all: one clear message with line and column.
#include "scenarios/document.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

TEST(JsonDocument, KnowsTheLineOfEveryValue) {
  const JsonDocument document =
      parse_document("{\n \"a\": 1,\n \"b\": [2,\n 3\n],\n \"c/d~\":\n {}}");
  EXPECT_EQ(document.lines.at(""), 1U);
  EXPECT_EQ(document.lines.at("/a"), 2U);
  EXPECT_EQ(document.lines.at("/b"), 3U);
  EXPECT_EQ(document.lines.at("/b/0"), 3U);
  EXPECT_EQ(document.lines.at("/b/1"), 4U);
  EXPECT_EQ(document.lines.at("/c~1d~0"), 7U);
}

TEST(JsonDocument, WholeNumbersAreIntegersHoweverWritten) {
  const JsonDocument document =
      parse_document("[480, 480.0, 4.8e2, 0.5, 18446744073709551615, -0.0]");
  EXPECT_EQ(document.root.dump(), "[480,480,480,0.5,1.8446744073709552e+19,0]");
  EXPECT_TRUE(document.root[1].is_number_integer());
  EXPECT_TRUE(document.root[4].is_number_float());
}

TEST(JsonDocument, SkipsAByteOrderMark) {
  EXPECT_EQ(parse_document("\xEF\xBB\xBF{}").root, nlohmann::json::object());
}

TEST(JsonDocument, NestingUpToTheLimit) {
  const std::string open(kMaximumNesting, '[');
  const std::string close(kMaximumNesting, ']');
  EXPECT_NO_THROW(parse_document(open + close));
}

TEST(BrokenJson, SaysWhereAndWhatWasExpected) {
  EXPECT_EQ(error_of_text(""), "my.json:1:1: nothing in it; a JSON object was expected");
  EXPECT_EQ(error_of_text(" \n "), "my.json:1:1: nothing in it; a JSON object was expected");
  EXPECT_EQ(error_of_text("{\"a\": 1,\n}"),
            "my.json:2:1: broken JSON: unexpected '}'; expected text in double quotes (a comma too "
            "many?)");
  EXPECT_EQ(error_of_text("{\"a\": [1,]}"),
            "my.json:1:10: broken JSON: unexpected ']'; expected a value (a comma too many?)");
  EXPECT_EQ(error_of_text("{\"a\": 1\n \"b\": 2}"),
            "my.json:2:3: broken JSON: unexpected text in double quotes; expected '}'");
  EXPECT_EQ(error_of_text("{\"a\": 1"),
            "my.json:1:8: broken JSON: unexpected end of input; expected '}'");
  EXPECT_EQ(error_of_text("{\"a\": nan}"), "my.json:1:7: broken JSON: no JSON value near 'nan'");
  EXPECT_EQ(error_of_text("{\"a\": NaN}"), "my.json:1:7: broken JSON: no JSON value near 'NaN'");
  EXPECT_EQ(error_of_text("{} {}"),
            "my.json:1:4: broken JSON: unexpected '{'; expected end of input");
  EXPECT_EQ(error_of_text("{\n // text\n}"),
            "my.json:2:2: broken JSON: no JSON value near '/' (JSON has no comments)");
}

TEST(BrokenJson, BinaryDataAndBadText) {
  EXPECT_EQ(error_of_text(std::string("\x89PNG\n\0\0", 7)),
            "my.json:2:1: not text but binary data");
  EXPECT_EQ(error_of_text("{\"a\": \"\xFF\"}"),
            "my.json:1:8: broken JSON: invalid string: ill-formed UTF-8 byte near '\uFFFD'");
  EXPECT_EQ(error_of_text("\xFF\xFE{}"), "my.json:1:1: broken JSON: no JSON value near '\uFFFD'");
}

TEST(BrokenJson, BeyondTheLimits) {
  EXPECT_EQ(error_of_text(std::string(100000, '[')),
            "my.json:1:65: nested more than 64 levels deep");
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_EQ(error_of_text(objects), "my.json:1:321: nested more than 64 levels deep");
  EXPECT_EQ(error_of_text("{\"a\": 1e999}"), "my.json:1:7: the number 1e999 is too large");
  EXPECT_EQ(error_of_text("{\"a\": 1,\n \"b\": {\"c\": 1, \"c\": 2}}"),
            "my.json:2:18: the key \"c\" stands twice in this object");
}

TEST(Shown, IsShortAndPrintable) {
  EXPECT_EQ(shown("a\n\"b\""), "\"a\\n\"b\"\"");
  EXPECT_EQ(shown(nlohmann::json::array({1, 2})), "an array of 2");
  EXPECT_LT(shown(std::string(100000, 'x')).size(), 200U);
}

}  // namespace
}  // namespace simbench::scenarios
