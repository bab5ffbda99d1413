#include "laws/usb_controller.h"

#include <gtest/gtest.h>

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
