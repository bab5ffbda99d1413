// Tables and prose on pages of a given width. Expectations are written out; then, over seeded
// random tables, what must hold of every layout.
#include "reports/text/plain_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <optional>
#include <sstream>

#include "reports/text/block.h"

namespace simbench::reports {
namespace {

// Sets the page for one test.
struct PageGuard {
  explicit PageGuard(std::size_t width) { set_page_width(width); }
  ~PageGuard() { set_page_width(std::nullopt); }
  PageGuard(const PageGuard&) = delete;
  PageGuard& operator=(const PageGuard&) = delete;
};

std::vector<std::string> lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(in, line);) found.push_back(line);
  return found;
}

std::size_t widest(const std::string& text) {
  std::size_t width = 0;
  for (const std::string& line : lines(text)) width = std::max(width, line.size());
  return width;
}

Table numbers() {
  Table table({{"name", Align::kLeft}, {"one"}, {"two"}, {"three"}});
  table.add({"a", "1", "22", "333"});
  table.add({"b", "4", "55", "666"});
  return table;
}

TEST(PlainTable, ATableThatFitsIsOneBlock) {
  const std::string unlimited = plain(numbers());
  const PageGuard page(21);
  EXPECT_EQ(widest(unlimited), 21);
  EXPECT_EQ(plain(numbers()), unlimited);
}

TEST(PlainTable, ATableTooWideIsDividedIntoBlocksOfLikeWidthWithTheKeyInEach) {
  const PageGuard page(20);
  EXPECT_EQ(plain(numbers()),
            "name  one  two\n"
            "----  ---  ---\n"
            "a       1   22\n"
            "b       4   55\n"
            "\n"
            "name  three\n"
            "----  -----\n"
            "a       333\n"
            "b       666\n");
}

TEST(PlainTable, EveryKeyColumnIsRepeated) {
  Table table({{"camera", Align::kLeft}, {"stream", Align::kLeft}, {"one"}, {"two"}}, 2);
  table.add({"a", "depth", "1", "2"});
  const PageGuard page(20);
  EXPECT_EQ(plain(table),
            "camera  stream  one\n"
            "------  ------  ---\n"
            "a       depth     1\n"
            "\n"
            "camera  stream  two\n"
            "------  ------  ---\n"
            "a       depth     2\n");
}

TEST(PlainTable, ProseGoesOnBelow) {
  Table table({{"name", Align::kLeft}, {"meaning", Align::kLeft}});
  table.add({"rate", "how often the trigger fires in a second"});
  const PageGuard page(32);
  EXPECT_EQ(plain(table),
            "name  meaning\n"
            "----  --------------------------\n"
            "rate  how often the trigger\n"
            "      fires in a second\n");
}

TEST(PlainTable, AWordIsNeverBroken) {
  Table table({{"name", Align::kLeft}, {"value"}});
  table.add({"a", std::string(50, 'x')});
  const PageGuard page(20);
  EXPECT_THAT(plain(table), testing::HasSubstr(fmt::format("a     {:x<50}\n", "")));
}

TEST(PlainTable, MarkdownKnowsNoPage) {
  const std::string unlimited = markdown(numbers());
  const PageGuard page(20);
  EXPECT_EQ(markdown(numbers()), unlimited);
}

TEST(PlainTable, LosesNoCellAndKeepsToThePage) {
  boost::random::mt19937 random(7);
  const auto pick = [&](int low, int high) {
    return boost::random::uniform_int_distribution<int>(low, high)(random);
  };
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    std::vector<Column> columns;
    for (int c = pick(1, 14); c > 0; --c) {
      columns.push_back({std::string(pick(1, 12), 'h'), pick(0, 1) ? Align::kLeft : Align::kRight});
    }
    Table table(columns);
    std::vector<std::string> words;
    for (int r = pick(0, 4); r > 0; --r) {
      std::vector<std::string> cells;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        std::string cell;
        for (int w = pick(1, 9); w > 0; --w) {
          words.push_back(fmt::format("w{}", words.size()));
          cell += fmt::format("{}{}", cell.empty() ? "" : " ", words.back());
        }
        cells.push_back(cell);
      }
      table.add(cells);
    }
    const std::size_t width = static_cast<std::size_t>(pick(54, 170));
    const PageGuard page(width);
    const std::string text = plain(table);
    EXPECT_LE(widest(text), width) << text;
    for (const std::string& word : words) {
      EXPECT_THAT(" " + text, testing::ContainsRegex("[ \n]" + word + "[ \n]"));
    }
    for (const std::string& line : lines(text)) EXPECT_FALSE(line.ends_with(' '));
  }
}

TEST(Prose, IsWrappedToThePageButNeverWiderThanTextWidth) {
  std::string prose;
  for (int i = 0; i < 60; ++i) prose += "word ";
  EXPECT_EQ(widest(wrapped(prose)), 139);
  for (const std::size_t width : {40, 80, 100, 160}) {
    const PageGuard page(width);
    const std::size_t found = widest(wrapped(prose, 4));
    EXPECT_LE(found, std::min(width, kTextWidth));
    EXPECT_GT(found + 5, std::min(width, kTextWidth));
  }
}

TEST(Fitted, BreaksLongLinesAtBlanksAndLeavesTheOthers) {
  const std::string text = "  short   line\n  a line that is   too long\nend";
  EXPECT_EQ(fitted(text), text);
  const PageGuard page(20);
  EXPECT_EQ(fitted(text), "  short   line\n  a line that is\n    too long\nend");
  EXPECT_EQ(fitted(fmt::format("{:x<30} y\n", "")), fmt::format("{:x<30}\n  y\n", ""));
  EXPECT_EQ(fitted(""), "");
}

// Colour for one test.
struct ColourGuard {
  ColourGuard() { set_page_colour(true); }
  ~ColourGuard() { set_page_colour(false); }
  ColourGuard(const ColourGuard&) = delete;
  ColourGuard& operator=(const ColourGuard&) = delete;
};

Table verdicts() {
  Table table({{"name", Align::kLeft},
               {.header = "is", .align = Align::kLeft, .is_verdict = true},
               {"value"}});
  table.add({"better", "better, by less than 1 %", "better"});
  table.add({"b", "no difference seen", "1"});
  table.add({"c", "no", "2"});
  table.add({"d", "limit", "3"});
  return table;
}

TEST(PlainTable, ColoursVerdictsAloneAndByTheirWords) {
  const std::string without = plain(verdicts());
  const ColourGuard colour;
  EXPECT_EQ(plain(verdicts()),
            "name    is                         value\n"
            "------  ------------------------  ------\n"
            "better  \x1b[32mbetter, by less than 1 %\x1b[0m  better\n"
            "b       no difference seen             1\n"
            "c       \x1b[31mno\x1b[0m                             2\n"
            "d       \x1b[36mlimit\x1b[0m                          3\n");
  const FilePage file;
  EXPECT_EQ(plain(verdicts()), without);
}

TEST(PlainTable, ColourHasNoWidth) {
  const Document document{.blocks = {{.table = verdicts()}}};
  const PageGuard page(40);
  const std::string without = plain(document);
  const ColourGuard colour;
  EXPECT_EQ(lines(plain(document)).size(), lines(without).size());
}

}  // namespace
}  // namespace simbench::reports
