#include "bags/topic_scan.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace simbench::bags {
namespace {

struct Arrival {
  std::int64_t log_ns;
  std::string head;
};

TopicScan scan_of(const std::vector<Arrival>& messages) {
  TopicArrivals arrivals;
  for (const Arrival& message : messages) {
    arrivals.add({.log_time = Nanoseconds(message.log_ns),
                  .size = message.head.size(),
                  .head = message.head});
  }
  TopicScan scan;
  arrivals.conclude(scan);
  return scan;
}

TEST(TopicScanTest, GapsAreThoseOfTheSortedTimes) {
  const TopicScan scan = scan_of({{50, "e"}, {10, "a"}, {20, "b"}, {45, "d"}, {22, "c"}});
  EXPECT_EQ(scan.messages, 5U);
  EXPECT_EQ(scan.out_of_order, 4U);
  EXPECT_EQ(scan.first, Nanoseconds(10));
  EXPECT_EQ(scan.last, Nanoseconds(50));
  EXPECT_EQ(scan.longest_gap, Nanoseconds(23));
  EXPECT_EQ(scan.gap_at, Nanoseconds(22));
  EXPECT_DOUBLE_EQ(scan.rate_hz(), 1e8);
}

TEST(TopicScanTest, MessagesOfOneTimeAreInOrder) {
  const TopicScan scan = scan_of({{1, "a"}, {2, "b"}, {2, "c"}, {3, "d"}});
  EXPECT_EQ(scan.out_of_order, 0U);
  EXPECT_EQ(scan.copies, 0U);
  EXPECT_EQ(scan.messages, 4U);
}

TEST(TopicScanTest, CopiesNeedTimesThatDiffer) {
  EXPECT_EQ(scan_of({{1, "a"}, {2, "b"}, {1, "a"}}).copies, 1U);
  EXPECT_EQ(scan_of({{1, "a"}, {2, "b"}, {1, "b"}}).copies, 0U);
  EXPECT_EQ(scan_of({{5, "a"}, {5, "a"}, {5, "a"}}).copies, 0U);
}

TEST(TopicScanTest, TimesBeyondAllTimeDoNotOverflow) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const TopicScan scan = scan_of({{kMost, "a"}, {-kMost - 1, "b"}});
  EXPECT_GT(scan.longest_gap, Nanoseconds(kMost / 4));
}

TEST(TopicScanTest, AnotherFileMayComeBefore) {
  TopicScan scan = scan_of({{100, "a"}, {130, "b"}});
  scan.append(scan_of({{10, "a"}, {20, "b"}}));
  EXPECT_EQ(scan.messages, 4U);
  EXPECT_EQ(scan.first, Nanoseconds(10));
  EXPECT_EQ(scan.last, Nanoseconds(130));
  EXPECT_EQ(scan.longest_gap, Nanoseconds(80));
  EXPECT_EQ(scan.gap_at, Nanoseconds(20));
  scan.append(scan_of({{300, "c"}}));
  EXPECT_EQ(scan.longest_gap, Nanoseconds(170));
  EXPECT_EQ(scan.gap_at, Nanoseconds(130));
}

}  // namespace
}  // namespace simbench::bags
