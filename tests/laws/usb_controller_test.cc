#include "laws/usb_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace simbench {
namespace {

// A byte a nanosecond, of eight streams.
constexpr UsbSettings kDedicated{.bytes_per_ns = 1, .buffered_frames = 16, .streams_per_lane = 1};
constexpr UsbSettings kFifo{.bytes_per_ns = 1, .buffered_frames = 16, .streams_per_lane = 8};
constexpr UsbSettings kFair{.bytes_per_ns = 1, .buffered_frames = 16, .is_fair = true};

using Completion = std::pair<std::uint32_t, std::int64_t>;  // ticket, ns

struct Offer {
  std::int64_t at_ns;
  std::size_t stream;
  double bytes;
};

// Offers frames 0, 1, ... and collects the completions as an owner would.
std::vector<Completion> run_transfers(const UsbSettings& settings,
                                      const std::vector<Offer>& offers) {
  UsbController bus(settings, 8);
  std::vector<Completion> completions;
  const auto collect_before = [&](Nanoseconds limit) {
    while (bus.next_completion() < limit) {
      const Nanoseconds now = bus.next_completion();
      while (const auto ticket = bus.take_completed(now)) {
        completions.emplace_back(*ticket, now.count());
      }
    }
  };
  std::uint32_t ticket = 0;
  for (const Offer& offer : offers) {
    const Nanoseconds at(offer.at_ns);
    collect_before(at);
    bus.submit(at, offer.stream, offer.bytes, ticket++);
  }
  collect_before(Nanoseconds::max());
  return completions;
}

TEST(UsbController, DedicatedCamerasDoNotDisturbEachOther) {
  EXPECT_EQ(run_transfers(kDedicated, {{0, 0, 300}, {0, 1, 300}, {10, 2, 100}}),
            (std::vector<Completion>{{2, 110}, {0, 300}, {1, 300}}));
}

TEST(UsbController, ADedicatedCameraTransfersItsOwnFramesOneAfterTheOther) {
  EXPECT_EQ(run_transfers(kDedicated, {{0, 0, 300}, {10, 0, 100}, {10, 1, 100}}),
            (std::vector<Completion>{{2, 110}, {0, 300}, {1, 400}}));
}

TEST(UsbController, StreamsOfACameraShareItsDedicatedBandwidth) {
  UsbController bus({.bytes_per_ns = 1, .buffered_frames = 4, .streams_per_lane = 2}, 4);
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 0, 100, 0));
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 1, 100, 1));
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 2, 150, 2));
  EXPECT_EQ(bus.take_completed(Nanoseconds(100)), 0u);
  EXPECT_EQ(bus.next_completion(), Nanoseconds(150));
  EXPECT_EQ(bus.take_completed(Nanoseconds(200)), 2u);
  EXPECT_EQ(bus.take_completed(Nanoseconds(200)), 1u);
}

TEST(UsbController, FifoTransfersOneAfterTheOther) {
  EXPECT_EQ(run_transfers(kFifo, {{0, 0, 300}, {0, 1, 300}, {10, 2, 100}, {1000, 0, 50}}),
            (std::vector<Completion>{{0, 300}, {1, 600}, {2, 700}, {3, 1050}}));
}

TEST(UsbController, FairSharesEqually) {
  // Three equal frames at once end together after three times the time of one.
  EXPECT_EQ(run_transfers(kFair, {{0, 0, 300}, {0, 1, 300}, {0, 2, 300}}),
            (std::vector<Completion>{{0, 900}, {1, 900}, {2, 900}}));
}

TEST(UsbController, FairSharingOfLateComersIsProcessorSharing) {
  // 0 alone for 100 ns; then half each: 1 needs 200 ns for its 100 bytes and ends at 300, when 0
  // has 100 of its 300 bytes left and the bus to itself.
  EXPECT_EQ(run_transfers(kFair, {{0, 0, 300}, {100, 1, 100}}),
            (std::vector<Completion>{{1, 300}, {0, 400}}));
}

TEST(UsbController, LosesWhatAStreamCannotBuffer) {
  UsbController bus({.bytes_per_ns = 1, .buffered_frames = 2, .streams_per_lane = 2}, 2);
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 0, 100, 0));
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 0, 100, 1));
  EXPECT_FALSE(bus.submit(Nanoseconds(0), 0, 100, 2));
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 1, 100, 3));
  EXPECT_EQ(bus.take_completed(Nanoseconds(100)), 0u);
  EXPECT_TRUE(bus.submit(Nanoseconds(100), 0, 100, 4));
}

TEST(UsbController, AFrameThatWouldBeTooLateIsRefusedAndTakesNoBandwidth) {
  for (const UsbSettings& settings : {kFifo, kFair}) {
    UsbController bus(settings, 8);
    EXPECT_TRUE(bus.submit(Nanoseconds(0), 0, 300, 0, Nanoseconds(300)));
    EXPECT_FALSE(bus.submit(Nanoseconds(10), 1, 301, 1, Nanoseconds(600)));
    EXPECT_TRUE(bus.submit(Nanoseconds(10), 1, 300, 2, Nanoseconds(600)));
    EXPECT_TRUE(bus.submit(Nanoseconds(10), 2, 900, 3)) << "any time will do";
    EXPECT_TRUE(bus.submit(Nanoseconds(1600), 3, 50, 4, Nanoseconds(1650))) << "idle by then";
  }
}

TEST(UsbController, ADedicatedCameraIsTooLateByItsOwnFramesAlone) {
  UsbController bus(kDedicated, 8);
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 0, 300, 0, Nanoseconds(300)));
  EXPECT_TRUE(bus.submit(Nanoseconds(0), 1, 300, 1, Nanoseconds(300)));
  EXPECT_FALSE(bus.submit(Nanoseconds(0), 0, 300, 2, Nanoseconds(300)));
}

// Cameras at a rate of their own each, in all phases: the share that an endless overload loses, and
// nothing below.
TEST(UsbController, LosesWhatItsBandwidthCannotCarry) {
  constexpr double kBytes = 1000;
  constexpr std::int64_t kPeriodNs = 10'000;
  constexpr int kPeriods = 4000;
  for (const UsbSettings& sharing : {kFifo, kFair}) {
    for (const double bytes_per_ns : {0.25, 0.4, 0.55, 0.599, 0.601, 1.0}) {
      UsbSettings settings = sharing;
      settings.bytes_per_ns = bytes_per_ns;
      settings.buffered_frames = 4;
      UsbController bus(settings, 8);
      int lost = 0;
      for (int i = 0; i < 6 * kPeriods; ++i) {
        const Nanoseconds at(i * kPeriodNs / 6);
        while (bus.next_completion() <= at) {
          const Nanoseconds now = bus.next_completion();
          while (bus.take_completed(now)) {
          }
        }
        lost += bus.submit(at, static_cast<std::size_t>(i % 6), kBytes, 0) ? 0 : 1;
      }
      const double offered = 6 * kBytes / static_cast<double>(kPeriodNs);
      const double expected = std::max(0.0, 1 - bytes_per_ns / offered);
      EXPECT_NEAR(static_cast<double>(lost) / (6 * kPeriods), expected, 24.0 / (6 * kPeriods))
          << bytes_per_ns << " of " << offered;
      if (bytes_per_ns > offered) {
        EXPECT_EQ(lost, 0);
      }
    }
  }
}

// However it is shared, a bus that is never idle carries its bandwidth and not more.
TEST(UsbController, NoSharingCreatesOrLosesBandwidth) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    std::vector<Offer> offers;
    double total = 0;
    for (int i = 0; i < 60; ++i) {
      const double bytes = static_cast<double>(50 + random() % 1000);
      offers.push_back({static_cast<std::int64_t>(i), i % 8u, bytes});
      total += bytes;
    }
    for (const UsbSettings& settings : {kFifo, kFair}) {
      const auto completions = run_transfers(settings, offers);
      ASSERT_EQ(completions.size(), offers.size()) << "seed " << seed;
      EXPECT_NEAR(static_cast<double>(completions.back().second), total, 61) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace simbench
