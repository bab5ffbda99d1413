// docs/reference/paper_statements.md, line by line: what it names exists, a value that it states is
// there, and no sentence of the paper is left out.
#include "tests/cli/paper_statements.h"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <vector>

#include "reports/figures/figure.h"
#include "tests/cli/program.h"
#include "tests/cli/statement_names.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class PaperStatements : public ProgramTest {
 protected:
  // What is wrong with the names in a line, each with the line.
  std::vector<std::string> problems_of(const StatementRow& row) {
    std::vector<std::string> problems;
    const auto keep = [&](const std::string& problem) {
      if (!problem.empty()) problems.push_back("line " + std::to_string(row.line) + ": " + problem);
    };
    const std::vector<std::string> places = quoted_names(row.where);
    const std::vector<std::string> tests = quoted_names(row.test);
    if (places.empty()) keep("nothing of simbench is named");
    if (tests.empty() && !row.test.starts_with("none: ")) keep("neither a test nor why none");
    for (const std::string& place : places) keep(names_.problem_of_place(place));
    for (const std::string& test : tests) keep(names_.problem_of_test(test));
    return problems;
  }

  // Returns the problems of a page that has only this line.
  std::vector<std::string> problems_of(const std::string& where, const std::string& test) {
    const StatementPage page =
        read_statements("| 1 | eq. (1) | it is so | " + where + " | " + test + " |\n");
    return problems_of(page.rows.at(0));
  }

  StatementNames names_{[this](const std::string& command) {
    const ProgramResult help = run({"help", command});
    return help.status == 0 ? help.out : std::string();
  }};
};

TEST_F(PaperStatements, NameWhatExists) {
  for (const StatementRow& row : nonempty(read_statements(statements_text()).rows)) {
    for (const std::string& problem : problems_of(row)) ADD_FAILURE() << problem;
  }
}

TEST(PaperCoverage, EverySentenceAndEveryNumberedPartHasItsLine) {
  for (const std::string& problem : problems_of_coverage(read_statements(statements_text()))) {
    ADD_FAILURE() << problem;
  }
}

TEST(PaperCoverage, EveryFigureOfThePaperThatIsDrawnIsNamed) {
  std::set<std::string> named;
  for (const StatementRow& row : nonempty(read_statements(statements_text()).rows)) {
    for (const std::string& name : quoted_names(row.where)) {
      if (const reports::FigureEntry* entry = reports::find_figure(name)) named.insert(entry->id);
    }
  }
  for (const reports::FigureEntry& entry : nonempty(reports::figure_catalogue())) {
    if (entry.paper.empty()) continue;
    EXPECT_THAT(named, Contains(entry.id));
  }
}

// A line that was made up is found, whatever it invents.
TEST_F(PaperStatements, AnInventedNameIsAProblem) {
  const std::string good = "`PublishedValues.OfTable2`";
  EXPECT_THAT(problems_of("`amd_ms`, `docs/design.md`, `/trigger/rate_hz`", good), IsEmpty());
  EXPECT_THAT(problems_of("`amd_ms`", "none: wiring"), IsEmpty());
  EXPECT_THAT(problems_of("`simbench figure fig8 --scenario 18cam_6host_45fps --seed 7`", good),
              IsEmpty());
  struct Case {
    std::string where;
    std::string says;
  };
  for (const Case& bad : std::vector<Case>{
           {"`reports/no_such.json`", "there is no file reports/no_such.json"},
           {"`18cam_6host_45fps /cameras/count = 17`", "found 18, not 17"},
           {"`18cam_6host_45fps /cameras/colour = 17`", "colour"},
           {"`18cam_6host_46fps /cameras/count = 18`", "18cam_6host_46fps"},
           {"`/cameras/colour`", "no scenario has /cameras/colour"},
           {"`/algorithms/yoon2021/stamp`", "no scenario has /algorithms/yoon2021/stamp"},
           {"`C99`", "simbench knows no C99"},
           {"`fig14`", "simbench knows no fig14"},
           {"`yoon2022_both`", "simbench knows no yoon2022_both"},
           {"`simbench dance`", "simbench has no command dance"},
           {"`simbench run --loud`", "run has no option --loud"},
           {"`simbench run --scenario 18cam`", "no scenario 18cam"},
           {"`simbench figure fig14`", "no figure fig14"},
           {"`simbench sweep --study dreams`", "no study dreams"},
           {"a method of ours", "nothing of simbench is named"}}) {
    EXPECT_THAT(problems_of(bad.where, good), ElementsAre(HasSubstr(bad.says))) << bad.where;
  }
  EXPECT_THAT(problems_of("`amd_ms`", "`PublishedValues.OfTable5`"),
              ElementsAre("line 1: there is no test PublishedValues.OfTable5"));
  EXPECT_THAT(problems_of("`amd_ms`", "by eye"), ElementsAre(HasSubstr("neither a test nor why")));
}

TEST(PaperCoverage, AGapIsAProblem) {
  const std::string text =
      "| 1 | 3.2/1: 1-2, 4; Fig. 2 a | it is so | `amd_ms` | none: so |\n"
      "| 3 | 3.2/2: 1; 3.3/1: 1; Fig. 14 | it is so | `amd_ms` | none: so |\n"
      "## 9 Sentences without a line\n"
      "| 3.2/1: 5 | why |\n"
      "## 10 Sentences of each paragraph\n"
      "| 3.2 | 6, 1 |\n";
  const std::vector<std::string> problems = problems_of_coverage(read_statements(text));
  EXPECT_THAT(problems, Contains("line 2: number 3 should be 2"));
  EXPECT_THAT(problems, Contains("line 2: the paper has no '3.3/1: 1'"));
  EXPECT_THAT(problems, Contains("line 2: the paper has no 'Fig. 14'"));
  EXPECT_THAT(problems, Contains("3.2/1: 3 is in no line"));
  EXPECT_THAT(problems, Contains("3.2/1: 6 is in no line"));
  EXPECT_THAT(problems, Contains("Fig. 1 is in no line"));
  EXPECT_THAT(problems, Not(Contains("Fig. 2 is in no line")));
  // 2 sentences, 23 of the 24 numbered parts, and the three above.
  EXPECT_THAT(problems, SizeIs(2 + 23 + 3));
}

}  // namespace
}  // namespace simbench
