#include "reports/text/time_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace simbench::reports {
namespace {

TEST(TimeText, TakesTheUnitThatFits) {
  EXPECT_EQ(time_text(1612), "1.61 s");
  EXPECT_EQ(time_text(543.2), "543 ms");
  EXPECT_EQ(time_text(2.924), "2.92 ms");
  EXPECT_EQ(time_text(0.694), "0.694 ms");
  EXPECT_EQ(time_text(0.0133), "13.3 us");
  EXPECT_EQ(time_text(0.00312), "3.12 us");
  EXPECT_EQ(time_text(0.000035), "35.0 ns");
  EXPECT_EQ(time_text(-0.0133), "-13.3 us");
  EXPECT_EQ(time_text(0), "0");
  EXPECT_EQ(time_text(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(time_text(std::numeric_limits<double>::infinity()), "-");
}

TEST(TimeText, ATickHasNoZeros) {
  EXPECT_EQ(tick_text(0.01), "10 us");
  EXPECT_EQ(tick_text(1), "1 ms");
  EXPECT_EQ(tick_text(0.1), "0.1 ms");
  EXPECT_EQ(tick_text(1e4), "10 s");
}

TEST(TimeText, ABandHasOneUnit) {
  EXPECT_EQ(time_band_text(1.45, 4.86), "[1.45, 4.86] ms");
  EXPECT_EQ(time_band_text(0.0121, 0.015), "[12.1, 15.0] us");
  EXPECT_EQ(time_band_text(435.9, 1373), "[0.436, 1.37] s");
  EXPECT_EQ(time_band_text(-0.002, 0.001), "[-2.00, 1.00] us");
  EXPECT_EQ(time_band_text(0, 0), "[0, 0]");
  EXPECT_EQ(time_band_text(1, std::numeric_limits<double>::quiet_NaN()), "-");
}

TEST(TimeText, AChangeHasOneUnitWhereThatIsReadable) {
  EXPECT_EQ(time_change_text(2.92, 1.89), "from 2.92 to 1.89 ms");
  EXPECT_EQ(time_change_text(0.0128, 0.00422), "from 12.8 to 4.22 us");
  EXPECT_EQ(time_change_text(1.5, 0.1), "from 1.50 to 0.100 ms");
  EXPECT_EQ(time_change_text(50, 0.00028), "from 50.0 ms to 0.280 us");
  EXPECT_EQ(time_change_text(2, 0), "from 2.00 ms to 0");
  EXPECT_EQ(time_change_text(0, 0), "from 0 to 0 ns");
  EXPECT_EQ(time_change_text(1, std::numeric_limits<double>::quiet_NaN()), "-");
}

}  // namespace
}  // namespace simbench::reports
