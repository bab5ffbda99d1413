#include "reports/text/text_table.h"

#include <gtest/gtest.h>

namespace simbench::reports {
namespace {

TextTable sample() {
  TextTable table({{"name", Align::kLeft}, {"AMD\nmedian ms"}, {"note", Align::kLeft}});
  table.add({"a", "1.5", "x|y"});
  table.add({"longer", "12345.25", ""});
  return table;
}

TEST(TextTable, PlainAlignsNumbersRightAndHeadersAtTheBottom) {
  EXPECT_EQ(sample().plain(),
            "              AMD\n"
            "name    median ms  note\n"
            "------  ---------  ----\n"
            "a             1.5  x|y\n"
            "longer   12345.25\n");
}

TEST(TextTable, MarkdownJoinsHeadersAndEscapesBars) {
  EXPECT_EQ(sample().markdown(),
            "| name | AMD median ms | note |\n"
            "|---|---:|---|\n"
            "| a | 1.5 | x\\|y |\n"
            "| longer | 12345.25 |  |\n");
}

TEST(TextTable, WithoutRowsHasItsHeader) {
  EXPECT_EQ(TextTable({{"a"}, {"b"}}).plain(), "a  b\n-  -\n");
}

TEST(TextTableDeathTest, ARowHasACellForEveryColumn) {
  TextTable table({{"a"}, {"b"}});
  EXPECT_DEATH(table.add({"1"}), "a cell for every column");
}

}  // namespace
}  // namespace simbench::reports
