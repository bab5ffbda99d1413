// Names that a terminal shows and does not obey, and cells of a line.
#include "recording/text_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace simbench {
namespace {

TEST(TakeCell, TakesOneCellAfterTheOtherAndThenNothing) {
  std::string_view line = " 17,, a b \t,last\r";
  EXPECT_EQ(take_cell(line), "17");
  EXPECT_EQ(take_cell(line), "");
  EXPECT_EQ(take_cell(line), "a b");
  EXPECT_EQ(take_cell(line), "last");
  EXPECT_EQ(take_cell(line), "");
  std::string_view blank = " \t";
  EXPECT_EQ(take_cell(blank), "");
  EXPECT_TRUE(blank.empty());
}

TEST(PrintableName, WhatControlsATerminalIsEscaped) {
  EXPECT_EQ(printable_name("a\x1b[2J\n\t\x7f"), "a\\x1b[2J\\x0a\\x09\\x7f");
  EXPECT_EQ(printable_name("\u0080\u0085\u009b"), "\\xc2\\x80\\xc2\\x85\\xc2\\x9b");
}

TEST(PrintableName, WhatControlsDirectionAndLinesIsEscaped) {
  for (const char* const mark :
       {"\u061c", "\u200e", "\u200f", "\u2028", "\u2029", "\u202a", "\u202b", "\u202c", "\u202d",
        "\u202e", "\u2060", "\u2066", "\u2067", "\u2068", "\u2069", "\ufeff"}) {
    const std::string shown = printable_name(mark);
    EXPECT_EQ(shown.size(), 4 * std::string(mark).size()) << shown;
    for (const char byte : shown) EXPECT_TRUE(byte > ' ' && byte <= '~') << shown;
  }
  EXPECT_EQ(printable_name("a\u202eb"), "a\\xe2\\x80\\xaeb");
}

TEST(PrintableName, LettersOfAllScriptsStay) {
  for (const char* const text : {"front 1", "Zürich", "50 µs", "左", "ش", "\U0001f3a5", "\u00a0",
                                 "\u200b\u200c\u200d", "\u202f", "\u205f", "\u2070", "\ufefe"}) {
    EXPECT_EQ(printable_name(text), text);
  }
}

TEST(PrintableName, WhatIsNoUtf8IsEscapedByteByByte) {
  EXPECT_EQ(printable_name("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(printable_name("\xc0\x9b"), "\\xc0\\x9b");           // overlong
  EXPECT_EQ(printable_name("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");  // overlong
  EXPECT_EQ(printable_name("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable_name("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(PrintableLines, KeepsLineEnds) {
  EXPECT_EQ(printable_lines("a\r\nb\u2028c\n"), "a\\x0d\nb\\xe2\\x80\\xa8c\n");
}

TEST(PrintableJson, MeansTheSame) {
  const nlohmann::json data = {{"n", "a\u202e\u0085\x1b\x7f\ufeff\u200d ü"}, {"m", 1}};
  const std::string text = printable_json(data.dump(2));
  EXPECT_EQ(nlohmann::json::parse(text), data);
  EXPECT_EQ(printable_lines(text), text);
}

TEST(CsvCell, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_cell("plain"), "plain");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(csv_cell("a\nb\x1b[2J\u202e"), "a\\x0ab\\x1b[2J\\xe2\\x80\\xae");
  EXPECT_EQ(csv_cell(NAN), "");
  EXPECT_EQ(csv_cell(0.1 + 0.2), "0.30000000000000004");
}

}  // namespace
}  // namespace simbench
