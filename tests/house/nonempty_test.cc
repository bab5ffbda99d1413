#include "tests/nonempty.h"

#include <gtest/gtest-spi.h>

#include <vector>

namespace simbench {
namespace {

TEST(Nonempty, FailsWhereALoopWouldCheckNothing) {
  EXPECT_NONFATAL_FAILURE(
      {
        for (const int each : nonempty(std::vector<int>{})) EXPECT_EQ(each, 0);
      },
      "nothing to check");
}

TEST(Nonempty, PassesOnWhatIsThere) {
  std::vector<int> named = {1, 2};
  EXPECT_EQ(&nonempty(named), &named);
  int sum = 0;
  for (const int each : nonempty(std::vector<int>{3, 4})) sum += each;
  EXPECT_EQ(sum, 7);
}

}  // namespace
}  // namespace simbench
