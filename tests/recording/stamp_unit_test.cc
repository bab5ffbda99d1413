#include "recording/stamp_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "recording/text_fields.h"

namespace simbench {
namespace {

TEST(StampUnit, IsReadFromAHeadingInAllUsualSpellings) {
  for (const char* heading :
       {"offset_ns", "offset_NS", "offset_nsec", "offsetNs", "offset (ns)", "offset [ns]",
        "offset:ns", "offset/ns", "offset ns", "ns", "TE_nanoseconds", "offset_ns_mean"}) {
    EXPECT_EQ(heading_unit(heading), kNanosecondUnit) << heading;
  }
  for (const char* heading : {"TE_usec", "offset (µs)", "offset [\xce\xbcs]", "offsetUs", "us"}) {
    EXPECT_EQ(heading_unit(heading), kMicrosecondUnit) << heading;
  }
  EXPECT_EQ(heading_unit("elapsed_msec"), kMillisecondUnit);
  EXPECT_EQ(heading_unit("HW Timestamp (ms)"), kMillisecondUnit);
  EXPECT_EQ(heading_unit("time_s"), kSecondUnit);
  EXPECT_EQ(heading_unit("time (s)"), kSecondUnit);
  EXPECT_EQ(heading_unit("offset_ps"), kPicosecondUnit);
  EXPECT_EQ(heading_unit("MJD"), (StampUnit{86'400, 1}));
  for (const char* heading :
       {"", "offset", "error", "bonus", "hosts", "status", "ns_per_us", "freq (ppb)", "s of x"}) {
    EXPECT_EQ(heading_unit(heading), std::nullopt) << heading;
  }
}

TEST(StampUnit, HasFactorsAndFrequencies) {
  EXPECT_EQ(unit_named("8ns"), (StampUnit{1, 125'000'000}));
  EXPECT_EQ(unit_named(" 8 ns "), unit_named("8ns"));
  EXPECT_EQ(unit_named("125MHz"), unit_named("8ns"));
  EXPECT_EQ(unit_named("90kHz"), (StampUnit{1, 90'000}));
  EXPECT_EQ(unit_named("1/30000s"), (StampUnit{1, 30'000}));
  EXPECT_EQ(unit_named("1001/30000 s"), (StampUnit{1001, 30'000}));
  for (const char* text : {"", "parsec", "0ns", "-8ns", "8", "8/0ns", "8//3ns", "ns8"}) {
    EXPECT_EQ(unit_named(text), std::nullopt) << text;
  }
}

TEST(StampUnit, ItsTextIsReadBack) {
  for (const char* text : {"s", "ms", "us", "ns", "ps", "8ns", "90kHz", "1001/30000s", "h"}) {
    const StampUnit unit = *unit_named(text);
    EXPECT_EQ(unit_named(unit_text(unit)), unit) << text << " " << unit_text(unit);
  }
  EXPECT_EQ(unit_text(kMicrosecondUnit), "us");
}

TEST(TimeIn, IsExactToTheNanosecond) {
  EXPECT_EQ(time_in("1725359542000000001", kNanosecondUnit),
            Nanoseconds(1'725'359'542'000'000'001));
  EXPECT_EQ(time_in("1725359542.123456789", kSecondUnit), Nanoseconds(1'725'359'542'123'456'789));
  EXPECT_EQ(time_in("-0.25", kMicrosecondUnit), Nanoseconds(-250));
  EXPECT_EQ(time_in("+3.333333333333333287e-02", kSecondUnit), Nanoseconds(33'333'333));
  EXPECT_EQ(time_in("1.700000000014576435e+09", kSecondUnit),
            Nanoseconds(1'700'000'000'014'576'435));
  EXPECT_EQ(time_in("4166666", *unit_named("8ns")), Nanoseconds(33'333'328));
  EXPECT_EQ(time_in("3000", *unit_named("90kHz")), Nanoseconds(33'333'333));
  EXPECT_EQ(time_in("60556.5", *unit_named("mjd")), Nanoseconds(5'232'081'600'000'000'000));
  EXPECT_EQ(time_in("1499.5", kPicosecondUnit), Nanoseconds(1));
  EXPECT_EQ(time_in("1500", kPicosecondUnit), Nanoseconds(2)) << "halves are rounded away from 0";
  EXPECT_EQ(time_in("0.000", kSecondUnit), Nanoseconds(0));
  EXPECT_EQ(time_in("1e-400", kSecondUnit), Nanoseconds(0));
  EXPECT_EQ(time_in(".5", kSecondUnit), Nanoseconds(500'000'000));
  EXPECT_EQ(time_in("5.", kSecondUnit), Nanoseconds(5'000'000'000));
}

TEST(TimeIn, RefusesWhatIsNoNumberOrTooLarge) {
  for (const char* text : {"", "-", ".", "1x", "x1", "1e", "1e5000", "1 ", " 1", "nan", "inf",
                           "0x1p3", "++1", "1.2.3", "9223372037", "1e300", "1,5"}) {
    EXPECT_EQ(time_in(text, kSecondUnit), std::nullopt) << text;
  }
}

TEST(TimeIn, AgreesWithTheExactReaderOfMilliseconds) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = random() % 2 == 0 ? "-" : "";
    text += std::to_string(random() % 4'000'000'000'000);
    if (random() % 3 != 0) {
      text += ".";
      for (unsigned digits = static_cast<unsigned>(random() % 12); digits-- > 0;) {
        text += static_cast<char>('0' + random() % 10);
      }
    }
    EXPECT_EQ(time_in(text, kMillisecondUnit), parse_ms(text, 4'000'000'000'000)) << text;
  }
}

}  // namespace
}  // namespace simbench
