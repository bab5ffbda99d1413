#include "reports/text/latex_text.h"

#include <gtest/gtest.h>

namespace simbench::reports {
namespace {

TEST(LatexText, SpecialCharactersAreWrittenOut) {
  EXPECT_EQ(latex_escaped("5-95 %, a_b & $c #1 {d}"), "5-95 \\%, a\\_b \\& \\$c \\#1 \\{d\\}");
  EXPECT_EQ(latex_escaped("\\x1b"), "\\textbackslash{}x1b");
  EXPECT_EQ(latex_escaped("~^<>|"),
            "\\textasciitilde{}\\textasciicircum{}\\textless{}\\textgreater{}\\textbar{}");
  EXPECT_EQ(latex_escaped("45 → 30"), "45 $\\rightarrow$ 30");
  EXPECT_EQ(latex_escaped("Zürich"), "Zürich");
  EXPECT_EQ(latex_escaped(""), "");
}

}  // namespace
}  // namespace simbench::reports
