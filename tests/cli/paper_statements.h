// docs/reference/paper_statements.md as data: the lines of its tables, the sentences of the paper
// that need none, and how many sentences each of the paper's paragraphs has.
//
// A sentence is named by section, paragraph and number: "3.2/1: 4-7, 9". What simbench has, and
// what tests it, are the words between backticks.
//
//   const StatementPage page = read_statements(statements_text());
//   for (const std::string& problem : problems_of_coverage(page)) ADD_FAILURE() << problem;
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace simbench {

struct StatementRow {
  int line = 0;                     // of the page
  std::string number;               // as written
  std::vector<std::string> places;  // "3.2/1: 4-7, 9", "Fig. 2 a", "eq. (1)"
  std::string where;
  std::string test;
};

struct StatementPage {
  std::vector<StatementRow> rows;
  std::vector<std::pair<int, std::string>> unlisted;     // line and place
  std::map<std::string, std::vector<int>> sentences_of;  // the paragraphs of each section
};

// The page's text.
std::string statements_text();

StatementPage read_statements(const std::string& text);

// The words between backticks.
std::vector<std::string> quoted_names(const std::string& cell);

// What is wrong with the numbers of the lines and the places that they name: sentences that are in
// no line or do not exist, and equations, algorithms, tables and figures of the paper that are in
// none.
std::vector<std::string> problems_of_coverage(const StatementPage& page);

}  // namespace simbench
