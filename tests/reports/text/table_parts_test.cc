#include "reports/text/table_parts.h"

#include <gmock/gmock.h>

namespace simbench::reports {
namespace {

using testing::ElementsAre;

TEST(TableParts, OneIfAllFits) {
  EXPECT_THAT(column_parts({10, 5, 5}, 1, 2, 24), ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_THAT(column_parts({10}, 1, 2, 24), ElementsAre(ElementsAre(0)));
  EXPECT_THAT(column_parts({10}, 3, 2, 24), ElementsAre(ElementsAre(0)));
}

TEST(TableParts, EachHasTheKeys) {
  EXPECT_THAT(column_parts({10, 5, 5, 5}, 1, 2, 24),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 3)));
  EXPECT_THAT(column_parts({4, 4, 5, 5}, 2, 2, 16),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 1, 3)));
}

// Four columns in two parts: two and two, not three and one.
TEST(TableParts, AreOfSimilarWidths) {
  EXPECT_THAT(column_parts({4, 4, 4, 4, 4}, 1, 1, 19),
              ElementsAre(ElementsAre(0, 1, 2), ElementsAre(0, 3, 4)));
}

TEST(TableParts, AColumnThatDoesNotFitHasItsOwn) {
  EXPECT_THAT(column_parts({4, 40, 4}, 1, 1, 19),
              ElementsAre(ElementsAre(0, 1), ElementsAre(0, 2)));
}

}  // namespace
}  // namespace simbench::reports
