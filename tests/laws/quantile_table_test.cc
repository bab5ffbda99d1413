#include "laws/quantile_table.h"

#include <gtest/gtest.h>

#include <vector>

namespace simbench {
namespace {

TEST(QuantileTable, OfAConstantIsConstant) {
  const std::vector<double> constant = {0.7, 0.7};
  for (const double p : {0.0, 0.3, 1.0}) EXPECT_EQ(QuantileTable(constant).value_at(p), 0.7) << p;
}

TEST(QuantileTable, OfAUniformIsALine) {
  const std::vector<double> uniform = {2, 3, 4, 5, 6};
  for (double p = 0; p <= 1; p += 0.0625) {
    EXPECT_DOUBLE_EQ(QuantileTable(uniform).value_at(p), 2 + 4 * p) << p;
  }
}

TEST(QuantileTable, GivesItsNumbersAtTheirProbabilities) {
  const std::vector<double> table = {0, 0.1, 0.1, 4, 100};
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(QuantileTable(table).value_at(static_cast<double>(i) / 4), table[i]) << i;
  }
  EXPECT_DOUBLE_EQ(QuantileTable(table).value_at(0.875), 52);
  EXPECT_EQ(QuantileTable(table).least(), 0);
}

TEST(QuantileTable, OfNothingIsEmpty) {
  EXPECT_TRUE(QuantileTable().empty());
  EXPECT_TRUE(QuantileTable(std::vector<double>{}).empty());
}

}  // namespace
}  // namespace simbench
