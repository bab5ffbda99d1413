#include "reports/text/program_name.h"

#include <gtest/gtest.h>

namespace simbench::reports {
namespace {

class ProgramName : public testing::Test {
 protected:
  ~ProgramName() override { set_program_name("simbench"); }
};

TEST_F(ProgramName, IsSimbenchUntilItIsSet) {
  EXPECT_EQ(program_name(), "simbench");
  EXPECT_EQ(in_this_program("see `simbench list`"), "see `simbench list`");
}

TEST_F(ProgramName, StandsInCitedCommandsOnly) {
  set_program_name("my_bench");
  EXPECT_EQ(in_this_program("see `simbench list` or `simbench run`"),
            "see `my_bench list` or `my_bench run`");
  EXPECT_EQ(in_this_program("simbench help"), "my_bench help");
  EXPECT_EQ(in_this_program("Examples:\n  simbench run\nsimbench x"),
            "Examples:\n  my_bench run\nmy_bench x");
  EXPECT_EQ(in_this_program("written by simbench 0.1"), "written by simbench 0.1");
  EXPECT_EQ(in_this_program("`simbench`"), "`simbench`");
  EXPECT_EQ(in_this_program(""), "");
}

}  // namespace
}  // namespace simbench::reports
