#include "recording/collected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace simbench {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Named {
  std::string name;
  int number = 0;
  int twice() const { return 2 * number; }
};

TEST(Collected, TakesAMemberOrWhatAFunctionMakes) {
  const std::vector<Named> list = {{"a", 1}, {"b", 2}};
  EXPECT_THAT(collected(list, &Named::name), ElementsAre("a", "b"));
  EXPECT_THAT(collected(list, &Named::twice), ElementsAre(2, 4));
  EXPECT_THAT(collected(list, [](const Named& each) { return each.name + "!"; }),
              ElementsAre("a!", "b!"));
}

TEST(Collected, KeepsAnEmptyListEmpty) {
  EXPECT_THAT(collected(std::vector<Named>{}, &Named::number), IsEmpty());
}

}  // namespace
}  // namespace simbench
