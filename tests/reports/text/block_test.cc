// What each renderer makes of the same blocks.
#include "reports/text/block.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::Not;

Table sample_table() {
  Table table({{"name", Align::kLeft}, {"AMD\nmedian ms"}, {"note", Align::kLeft}});
  table.add({"a", "1.5", "x|y"});
  table.add({"longer", "12345.25", ""});
  return table;
}

Document sample_document() {
  return {.title = "a title",
          .head = {"What it is about."},
          .blocks = {{.heading = "Numbers", .table = sample_table(), .prose = {"A sentence."}},
                     {.heading = "What went wrong", .items = {"this", "that"}, .is_warning = true},
                     {.prose = {"The end."}}}};
}

TEST(Table, PlainAlignsNumbersRightAndHeadersAtTheBottom) {
  EXPECT_EQ(plain(sample_table()),
            "              AMD\n"
            "name    median ms  note\n"
            "------  ---------  ----\n"
            "a             1.5  x|y\n"
            "longer   12345.25\n");
}

TEST(Table, MarkdownJoinsHeadersAndEscapesBars) {
  EXPECT_EQ(markdown(sample_table()),
            "| name | AMD median ms | note |\n"
            "|---|---:|---|\n"
            "| a | 1.5 | x\\|y |\n"
            "| longer | 12345.25 |  |\n");
}

TEST(Document, LatexHasBooktabsTablesAndEscapes) {
  Table table({{"name_1", Align::kLeft}, {"AMD\n5-95 %"}});
  table.add({"a&b", "-1.5"});
  table.add({"\\", "-"});
  const Document document{.title = "a_b",
                          .head = {"changed: 45 → 30"},
                          .blocks = {{.heading = "50 % #1", .table = table, .prose = {"{x}"}},
                                     {.heading = "Notes", .items = {"[y]", "$z"}}}};
  EXPECT_EQ(latex(document),
            "% Needs \\usepackage{array,booktabs,longtable}. Fits the class article in one "
            "column.\n"
            "{\\sloppy\n"
            "\\subsection*{a\\_b}\n"
            "\nchanged: 45 $\\rightarrow$ 30\n"
            "\n\\begin{table}[!htbp]\n"
            "  \\centering\n"
            "  \\footnotesize\n"
            "  \\setlength{\\tabcolsep}{4pt}\n"
            "  \\caption{50 \\% \\#1}\n"
            "  \\begin{tabular}{lr}\n"
            "    \\toprule\n"
            "     & AMD \\\\\n"
            "    name\\_1 & 5-95 \\% \\\\\n"
            "    \\midrule\n"
            "    a\\&b & $-$1.5 \\\\\n"
            "    \\textbackslash{} & - \\\\\n"
            "    \\bottomrule\n"
            "  \\end{tabular}\n"
            "\\end{table}\n"
            "\n\\{x\\}\n"
            "\n\\paragraph{Notes}\n"
            "\n\\begin{itemize}\n"
            "  \\item {}[y]\n"
            "  \\item {}\\$z\n"
            "\\end{itemize}\n"
            "\\par}\n");
  EXPECT_EQ(drawn_as("latex", document), latex(document));
  EXPECT_EQ(drawn_as("markdown", document), markdown(document));
  EXPECT_EQ(drawn_as("table", document), plain(document));
}

TEST(Document, HasTheChosenColumnsBesideTheKeys) {
  Table other({{"host", Align::kLeft}, {"offset"}});
  other.add({"a", "1"});
  const Document document{.blocks = {{.heading = "One", .table = sample_table()},
                                     {.heading = "Two", .table = other, .prose = {"text"}}}};
  const Document chosen = with_columns(document, {"note"});
  EXPECT_EQ(plain(*chosen.blocks[0].table),
            "name    note\n"
            "------  ----\n"
            "a       x|y\n"
            "longer\n");
  EXPECT_FALSE(chosen.blocks[1].table.has_value());
  EXPECT_EQ(chosen.blocks[1].prose.size(), 1U);
  EXPECT_EQ(plain(with_columns(document, {})), plain(document));
  EXPECT_EQ(with_columns(document, {"AMD median ms", "offset"}).blocks[1].table->columns.size(),
            2U);
  EXPECT_THAT([&] { with_columns(document, {"AMD"}); },
              testing::ThrowsMessage<scenarios::InputError>(
                  testing::HasSubstr("found 'AMD', allowed: AMD median ms, note, offset")));
}

Document wide_document(std::size_t columns, std::size_t rows) {
  std::vector<Column> heads = {{"name", Align::kLeft}};
  for (std::size_t c = 0; c < columns; ++c) heads.push_back({fmt::format("column {}", c)});
  Table table(std::move(heads));
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<std::string> cells = {fmt::format("row {}", row)};
    for (std::size_t c = 0; c < columns; ++c) cells.push_back(fmt::format("{}.{}", row, c));
    table.add(std::move(cells));
  }
  return {.blocks = {{.heading = "Wide", .table = std::move(table)}}};
}

std::size_t count_in(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Document, LatexDividesWhatIsWiderThanAPage) {
  const std::string text = latex(wide_document(14, 3));
  EXPECT_GE(count_in(text, "\\begin{table}"), 2U);
  EXPECT_EQ(count_in(text, "\\begin{table}"), count_in(text, "row 2 &"));
  EXPECT_THAT(text, testing::HasSubstr("\\caption{Wide, part 1 of "));
  EXPECT_EQ(count_in(text, " 2.13 "), 1U) << "each column once";
  EXPECT_EQ(count_in(latex(wide_document(3, 3)), "\\begin{table}"), 1U);
}

TEST(Document, LatexLetsLongTablesGoOverPages) {
  const std::string text = latex(wide_document(3, 60));
  EXPECT_EQ(count_in(text, "\\begin{longtable}"), 1U);
  EXPECT_EQ(count_in(text, "name & column 0"), 2U) << "the heading of every page";
  EXPECT_EQ(count_in(latex(wide_document(3, 20)), "\\begin{longtable}"), 0U);
}

TEST(Document, LatexWrapsWordsAndBreaksLongNames) {
  Table table({{"name", Align::kLeft}, {"meaning", Align::kLeft}, {"value"}});
  table.add(
      {"a_name_of_several_words_which_is_long", std::string(30, 'x') + " and more words", "1"});
  const std::string text =
      latex(Document{.blocks = {{.table = table, .prose = {"/a/pointer/of/some/length 45 %"}}}});
  EXPECT_EQ(count_in(text, "\\raggedright\\arraybackslash}p{"), 2U);
  EXPECT_THAT(text, testing::HasSubstr("a\\_\\allowbreak{}name\\_\\allowbreak{}"));
  EXPECT_THAT(text, testing::HasSubstr("/\\allowbreak{}length 45 \\%"));
}

// Names of scenarios and pipelines come from files that anyone may have written.
TEST(Document, TerminalEscapesAreShownAndNotObeyed) {
  const std::string name = "\x1b[2J\x1b]0;mine\x07\u009b31m\r";
  const std::string shown = "\\x1b[2J\\x1b]0;mine\\x07\\xc2\\x9b31m\\x0d";
  Table table({{"pipeline", Align::kLeft}, {"AMD\nms" + name}});
  table.add({name, "1"});
  const Document document{
      .title = name,
      .head = {name},
      .blocks = {{.heading = name, .table = table, .prose = {name}}, {.items = {name}}}};
  for (const std::string& text : {plain(document), markdown(document), plain(table)}) {
    EXPECT_EQ(text.find_first_of("\x1b\x07\r\x9b"), std::string::npos) << text;
    EXPECT_THAT(text, HasSubstr(shown));
  }
}

TEST(Table, HtmlHasItsCellsAsText) {
  Table table({{"name", Align::kLeft}, {"AMD\nms", Align::kRight, "a \"mean\""}});
  table.add({"<b>", "1.500"});
  const std::string text = html(table, "A <caption>");
  EXPECT_THAT(text, HasSubstr("<th scope=\"row\" class=\"text\">&lt;b&gt;</th><td>1.500</td>"));
  EXPECT_THAT(text, HasSubstr("<caption>A &lt;caption&gt;</caption>"));
  EXPECT_THAT(text, HasSubstr("<th scope=\"col\" title=\"a &quot;mean&quot;\">AMD ms</th>"));
}

TEST(Table, HtmlHeadsARowByAllItsKeys) {
  Table table({{"camera"}, {"stream"}, {"ms"}}, 2);
  table.add({"c", "depth", "1"});
  EXPECT_THAT(html(table, ""), HasSubstr("<th scope=\"row\" class=\"text\">depth</th><td>1</td>"));
}

TEST(Table, WithoutRowsHasItsHeader) { EXPECT_EQ(plain(Table({{"a"}, {"b"}})), "a  b\n-  -\n"); }

TEST(Table, IsMadeOfFields) {
  const std::vector<Field<int>> fields = {
      {{"number"}, [](int number) { return std::to_string(number); }},
      {{"twice"}, [](int number) { return std::to_string(2 * number); }}};
  EXPECT_EQ(plain(table_of(fields, std::vector<int>{1, 20})),
            "number  twice\n"
            "------  -----\n"
            "     1      2\n"
            "    20     40\n");
}

TEST(TableDeathTest, ARowHasACellForEveryColumn) {
  Table table({{"a"}, {"b"}});
  EXPECT_DEATH(table.add({"1"}), "a cell for every column");
}

TEST(Document, PlainHasAnEmptyLineBetweenBlocks) {
  EXPECT_EQ(plain(sample_document()), "a title\nWhat it is about.\n\nNumbers\n\n" +
                                          plain(sample_table()) +
                                          "\nA sentence.\n\nWhat went wrong\n  this\n  that\n"
                                          "\nThe end.\n");
}

TEST(Document, MarkdownHasHeadingsAndLists) {
  EXPECT_EQ(markdown(sample_document()),
            "## a title\n\nWhat it is about.\n\n### Numbers\n\n" + markdown(sample_table()) +
                "\nA sentence.\n\n### What went wrong\n\n- this\n- that\n\nThe end.\n");
}

TEST(Document, WithoutATitleABlockBeginsIt) {
  const Document document{.blocks = {{.heading = "Numbers", .table = sample_table()}}};
  EXPECT_EQ(plain(document), "Numbers\n\n" + plain(sample_table()));
  EXPECT_EQ(markdown(document), "## Numbers\n\n" + markdown(sample_table()));
}

TEST(Document, PlainFitsThePage) {
  set_page_width(12);
  const std::string text = plain(sample_document());
  set_page_width(std::nullopt);
  EXPECT_THAT(text, HasSubstr("What it is\nabout.\n"));
  EXPECT_THAT(text, HasSubstr("What went\n  wrong\n"));
}

TEST(Document, HtmlIsItsHeadAndItsBlocks) {
  Document document = sample_document();
  document.head = {"a < b"};
  EXPECT_EQ(html(document), "<p>a &lt; b</p>\n" + html(document.blocks));
  EXPECT_EQ(drawn_as("html", document), html(document));
}

TEST(Document, HtmlHasASectionForEachBlock) {
  const std::string text = html(sample_document().blocks);
  EXPECT_THAT(text, HasSubstr("<section>\n<h3>Numbers</h3>\n<div class=\"scroll\""));
  EXPECT_THAT(text, HasSubstr("<p class=\"legend\">A sentence.</p>\n</section>\n"));
  EXPECT_THAT(text, HasSubstr("<section class=\"warnings\">\n<h3>What went wrong</h3>\n<ul>\n"
                              "<li>this</li>\n<li>that</li>\n</ul>\n</section>\n"));
  EXPECT_THAT(html(Block{.heading = "<h>", .items = {"<i>"}}),
              testing::AllOf(HasSubstr("&lt;h&gt;"), HasSubstr("<li>&lt;i&gt;</li>"),
                             Not(HasSubstr("<i>"))));
}

}  // namespace
}  // namespace simbench::reports
