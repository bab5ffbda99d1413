#include "recording/table.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using Rows = std::vector<std::vector<std::string>>;

struct Read {
  TableDialect dialect{};
  std::vector<std::string> heading{};
  Rows rows{};
};

Read read_rows(const std::string& text) {
  TableReader table(LineReader("t.csv", text));
  Read found{.dialect = table.dialect(), .heading = table.heading()};
  while (const std::vector<std::string_view>* cells = table.next()) {
    found.rows.emplace_back(cells->begin(), cells->end());
  }
  return found;
}

TEST(Table, FindsTheSeparator) {
  for (const char* separator : {",", ";", "\t", " ", "   ", " \t ", ", ", " ; "}) {
    const std::string text =
        std::string("t") + separator + "x_ns\n0" + separator + "64\n1" + separator + "-24\n";
    const Read found = read_rows(text);
    EXPECT_THAT(found.heading, ElementsAre("t", "x_ns")) << separator;
    EXPECT_EQ(found.rows, (Rows{{"0", "64"}, {"1", "-24"}})) << separator;
  }
}

TEST(Table, ReadsDecimalCommas) {
  for (const char* separator : {";", "\t", " "}) {
    const Read found =
        read_rows(std::string("0,5") + separator + "1,25e-6\n1" + separator + "-2\n");
    EXPECT_TRUE(found.dialect.decimal_comma) << separator;
    EXPECT_EQ(found.rows, (Rows{{"0.5", "1.25e-6"}, {"1", "-2"}})) << separator;
  }
  EXPECT_EQ(read_rows("0,5\n1,5\n").rows, (Rows{{"0", "5"}, {"1", "5"}})) << "two columns";
}

TEST(Table, ReadsQuotes) {
  const Read found = read_rows("\"a\",\"b \"\"x\"\"\"\n\"1\",\"2, and 3\"\n 4 ,\"\"\n");
  EXPECT_THAT(found.heading, ElementsAre("a", "b \"x\""));
  EXPECT_EQ(found.rows, (Rows{{"1", "2, and 3"}, {"4", ""}}));
  TableReader open(LineReader("t.csv", "a,b\n1,2\n\"3,4\n"));
  open.next();
  try {
    open.next();
    FAIL() << "a quote without its end";
  } catch (const LineError& error) {
    EXPECT_THAT(error.what(), StartsWith("t.csv:3: found a quote without its end"));
  }
}

TEST(Table, TakesACommentedHeading) {
  EXPECT_THAT(read_rows("# time_s,offset_ns\n0.0,6.4e1\n").heading,
              ElementsAre("time_s", "offset_ns"));
  const Read tum =
      read_rows("# rgb maps\n# file: own\n# timestamp filename\n1.5 a.png\n2.5 b.png\n");
  EXPECT_THAT(tum.heading, ElementsAre("timestamp", "filename"));
  EXPECT_EQ(tum.rows, (Rows{{"1.5", "a.png"}, {"2.5", "b.png"}}));
  EXPECT_THAT(read_rows("% a comment\n1,2\n// more\n3,4\n").rows, SizeIs(2));
  EXPECT_THAT(read_rows("###\n#\n1,2\n").heading, IsEmpty());
}

TEST(Table, HasNoHeadingWhereTheFirstRowHasValues) {
  EXPECT_THAT(read_rows("0,1\n1,2\n").heading, IsEmpty());
  EXPECT_THAT(read_rows("nan,1\n1,2\n").heading, IsEmpty());
  EXPECT_THAT(read_rows("2024-09-03T10:32:22Z,x\n").heading, IsEmpty());
  EXPECT_THAT(read_rows("\n\n1700000000123455872\n1700000000173456000\n").heading, IsEmpty());
  EXPECT_EQ(read_rows("1700000000123455872\n17\n").dialect.separator, TableDialect::kOneColumn);
}

TEST(Table, ADayAndATimeAreOneCell) {
  EXPECT_EQ(read_rows("2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.064389445\n").rows,
            (Rows{{"2011-09-26 13:02:25.964389445"}, {"2011-09-26 13:02:26.064389445"}}));
  EXPECT_EQ(read_rows("2011-09-26 13:02:25 0.5\n2011-09-26 13:02:26 0.25\n").rows,
            (Rows{{"2011-09-26 13:02:25", "0.5"}, {"2011-09-26 13:02:26", "0.25"}}));
}

TEST(Table, PlacesAreLinesOfTheFile) {
  TableReader table(LineReader("t.csv", "# c\n\na,b\r\n1,2\r\n\n3,4\r\n5,6"));
  table.next();
  EXPECT_EQ(table.place(), "t.csv:4");
  table.next();
  EXPECT_EQ(table.place(), "t.csv:6");
  EXPECT_EQ(table.next(), nullptr);
  EXPECT_TRUE(table.torn());
}

TEST(Table, RowsBeyondThoseThatWereLookedAtAreReadTheSame) {
  std::string text = "t;x\n";
  for (int i = 0; i < 1000; ++i) text += std::to_string(i) + ";" + std::to_string(2 * i) + ",5\n";
  const Read found = read_rows(text);
  ASSERT_THAT(found.rows, SizeIs(1000));
  EXPECT_THAT(found.rows[999], ElementsAre("999", "1998.5"));
}

TEST(Table, MissingCells) {
  for (const char* cell : {"", "nan", "NaN", "NA", "n/a", "null", "None", "-", "NaT"}) {
    EXPECT_TRUE(is_missing_cell(cell)) << cell;
  }
  for (const char* cell : {"0", "-1", "nano", "inf", "x"})
    EXPECT_FALSE(is_missing_cell(cell)) << cell;
}

}  // namespace
}  // namespace simbench
