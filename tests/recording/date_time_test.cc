#include "recording/date_time.h"

#include <gtest/gtest.h>

namespace simbench {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
// 2024-09-03T10:32:22Z
constexpr std::int64_t kMorning = 1'725'359'542 * kSecond;

TEST(DateTime, ReadsTheFormsOfIso8601) {
  for (const char* text :
       {"2024-09-03T10:32:22Z", "2024-09-03 10:32:22", "2024-09-03T10:32:22.000+00:00",
        "2024-09-03T12:32:22+0200", "2024-09-03 12:32:22+02", "2024-09-03T05:02:22-05:30",
        "2024-09-03 10:32:22 UTC", "2024-09-03 10:32:22.0 +0000"}) {
    EXPECT_EQ(date_time_in(text), Nanoseconds(kMorning)) << text;
  }
  EXPECT_EQ(date_time_in("2024-09-03T10:32:22,123456789Z"), Nanoseconds(kMorning + 123'456'789));
  EXPECT_EQ(date_time_in("2024-09-03T10:32:22.1234567891Z"), Nanoseconds(kMorning + 123'456'789));
  EXPECT_EQ(date_time_in("2016-12-31T23:59:60Z"), date_time_in("2017-01-01T00:00:00Z"));
  EXPECT_EQ(date_time_in("1970-01-01T00:00:00Z"), Nanoseconds(0));
}

TEST(DateTime, RefusesWhatIsNone) {
  for (const char* text :
       {"", "2024-09-03", "10:32:22", "2024-13-03T10:32:22Z", "2024-02-30T10:32:22Z",
        "2024-09-03T24:32:22Z", "2024-09-03T10:60:22Z", "2024-09-03T10:32:61Z",
        "2024-09-03T10:32:22.Z", "2024-09-03T10:32Z", "2024-09-03X10:32:22",
        "2024-09-03T10:32:22+15:00", "9999-09-03T10:32:22Z", "2024-09-03T10:32:22 CEST",
        "03/09/2024 10:32:22"}) {
    EXPECT_EQ(date_time_in(text), std::nullopt) << text;
  }
}

TEST(DateTime, DaysAndTimesAlone) {
  EXPECT_EQ(day_in("1970-01-02")->time_since_epoch(), std::chrono::days(1));
  EXPECT_EQ(time_of_day_in("00:01:02.5"), Nanoseconds(62 * kSecond + kSecond / 2));
  EXPECT_EQ(time_of_day_in("1:02:03"), std::nullopt);
}

}  // namespace
}  // namespace simbench
