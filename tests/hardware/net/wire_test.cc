// What is sealed, numbered and remembered: the parts of the network that need no sockets.
#include "hardware/net/wire.h"

#include <gmock/gmock.h>

#include <boost/asio/ip/address.hpp>
#include <random>
#include <set>

#include "hardware/net/datagram.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/token_bucket.h"
#include "tests/hardware/net/in_time.h"

namespace simbench::hardware {
namespace {

const KeyBytes kThere{1};
const KeyBytes kBack{2};

TEST(Sealing, EveryBitThatDiffersIsNoticed) {
  const Bytes header = bytes_of("head");
  const Bytes sent = header_and_sealed(kThere, 5, header, bytes_of("a message of some length"));
  const Bytes sealed(sent.begin() + static_cast<std::ptrdiff_t>(header.size()), sent.end());
  ASSERT_TRUE(open_sealed(kThere, 5, header, sealed));
  for (std::size_t bit = 0; bit < 8 * sealed.size(); ++bit) {
    Bytes damaged = sealed;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    EXPECT_FALSE(open_sealed(kThere, 5, header, damaged)) << bit;
  }
  for (std::size_t size = 0; size < sealed.size(); ++size) {
    EXPECT_FALSE(open_sealed(kThere, 5, header, std::span(sealed).first(size))) << size;
  }
  EXPECT_FALSE(open_sealed(kThere, 5, bytes_of("heaD"), sealed));
  EXPECT_FALSE(open_sealed(kThere, 6, header, sealed));
  EXPECT_FALSE(open_sealed(kBack, 5, header, sealed));
}

TEST(Sealing, KeysDifferByKeyPurposeAndContext) {
  const Bytes context = bytes_of("context");
  const std::set<KeyBytes> keys = {
      derive_key(kThere, "a", context), derive_key(kBack, "a", context),
      derive_key(kThere, "b", context), derive_key(kThere, "a", bytes_of("contexT")),
      derive_key(kThere, "ac", bytes_of("ontext"))};
  EXPECT_EQ(keys.size(), 5u);
}

TEST(Datagram, IsAcceptedOnce) {
  DatagramSession sender(3, kThere, kBack);
  DatagramSession receiver(0, kBack, kThere);
  const Bytes datagram = sender.seal_next(bytes_of("hello"));
  const auto header = parse_datagram(datagram);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->from, 3);
  Bytes message;
  EXPECT_EQ(receiver.open(*header, datagram, message), DatagramVerdict::kAccepted);
  EXPECT_EQ(text_of(message), "hello");
  EXPECT_EQ(receiver.open(*header, datagram, message), DatagramVerdict::kReplayed);
}

TEST(Datagram, EveryBitThatDiffersIsNoticed) {
  DatagramSession sender(3, kThere, kBack);
  DatagramSession receiver(0, kBack, kThere);
  const Bytes datagram = sender.seal_next(bytes_of("hello"));
  Bytes message;
  for (std::size_t bit = 0; bit < 8 * datagram.size(); ++bit) {
    Bytes damaged = datagram;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    const auto header = parse_datagram(damaged);
    if (header) {
      EXPECT_EQ(receiver.open(*header, damaged, message), DatagramVerdict::kForged) << bit;
    }
  }
  // None of them moved the window.
  EXPECT_EQ(receiver.open(*parse_datagram(datagram), datagram, message),
            DatagramVerdict::kAccepted);
}

TEST(Datagram, TruncatedAndOversizedOnesAreNone) {
  DatagramSession sender(3, kThere, kBack);
  const Bytes datagram = sender.seal_next({});
  for (std::size_t size = 0; size < datagram.size(); ++size) {
    EXPECT_FALSE(parse_datagram(std::span(datagram).first(size))) << size;
  }
  Bytes large = sender.seal_next(Bytes(kChannelBytes + kMaxDatagramMessage));
  EXPECT_TRUE(parse_datagram(large));
  large.push_back({});
  EXPECT_FALSE(parse_datagram(large));
}

TEST(Datagram, AMessageComesBackWithItsChannel) {
  for (const Transport channel : kDatagramChannels) {
    Bytes message = with_channel(channel, bytes_of("text"));
    EXPECT_EQ(message.size(), kChannelBytes + 4);
    EXPECT_EQ(take_channel(message), channel);
    EXPECT_EQ(text_of(message), "text");
  }
}

TEST(Datagram, OtherChannelsThanTheTwoAreNone) {
  Bytes empty;
  EXPECT_EQ(take_channel(empty), std::nullopt);
  for (int number = 2; number < 256; ++number) {
    Bytes message = {static_cast<std::byte>(number)};
    EXPECT_EQ(take_channel(message), std::nullopt) << number;
  }
}

// What one's own datagrams are sealed with does not open what comes.
TEST(Datagram, OnesOwnIsNotAcceptedBack) {
  DatagramSession session(3, kThere, kBack);
  const Bytes datagram = session.seal_next(bytes_of("mirror"));
  Bytes message;
  EXPECT_EQ(session.open(*parse_datagram(datagram), datagram, message), DatagramVerdict::kForged);
}

TEST(ReplayWindow, TakesEachOnceWithinTheWindow) {
  ReplayWindow window;
  for (const std::uint64_t counter : {5u, 3u, 4u, 0u, 2000u}) {
    EXPECT_TRUE(window.is_fresh(counter)) << counter;
    window.accept(counter);
    EXPECT_FALSE(window.is_fresh(counter)) << counter;
  }
  EXPECT_TRUE(window.is_fresh(2000 - ReplayWindow::kSize + 1));
  EXPECT_FALSE(window.is_fresh(2000 - ReplayWindow::kSize));
  window.accept(~std::uint64_t{0});
  EXPECT_FALSE(window.is_fresh(~std::uint64_t{0}));
  EXPECT_FALSE(window.is_fresh(2001));
}

// Against a set of all that was accepted.
TEST(ReplayWindow, AgreesWithASetOfAllCounters) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  ReplayWindow window;
  std::set<std::uint64_t> accepted;
  std::uint64_t middle = 0;
  for (int i = 0; i < 200000; ++i) {
    if (random() % 50 == 0) middle += random() % 3000;
    const std::uint64_t counter = middle + random() % 1500;
    const bool in_window = accepted.empty() || counter + ReplayWindow::kSize > *accepted.rbegin();
    ASSERT_EQ(window.is_fresh(counter), in_window && !accepted.contains(counter)) << counter;
    if (!window.is_fresh(counter)) continue;
    window.accept(counter);
    accepted.insert(counter);
  }
}

TEST(TokenBucket, GivesTheBurstAndThenTheRate) {
  TokenBucket bucket;
  const MonotonicTime start{std::chrono::seconds(1000)};
  int given = 0;
  for (int ms = 0; ms < 10000; ++ms) {
    given += bucket.take(start + std::chrono::milliseconds(ms), 50, 20);
  }
  EXPECT_NEAR(given, 20 + 50 * 10, 1);
}

TEST(SourceBuckets, AFloodFromOneSourceLeavesOthersTheirs) {
  SourceBuckets buckets(10, 5);
  const auto address = boost::asio::ip::make_address("10.0.0.1");
  const MonotonicTime now{std::chrono::seconds(1000)};
  for (int i = 0; i < 1000; ++i) buckets.take(address, 7, now);
  EXPECT_FALSE(buckets.take(address, 7, now));
  EXPECT_TRUE(buckets.take(address, 8, now));
}

MonotonicTime at_us(int us) { return MonotonicTime(std::chrono::microseconds(us)); }

TEST(TransmitLog, JoinsStampsWithMessages) {
  TransmitLog log;
  log.sent(10, 100, at_us(1));
  log.sent(11, 150, at_us(2));
  log.stamped(150, at_us(5));
  log.stamped(150, at_us(9));
  log.stamped(7, at_us(5));
  EXPECT_EQ(log.find(11)->left, at_us(5));
  EXPECT_EQ(log.find(10)->left, std::nullopt);
  EXPECT_EQ(log.find(10)->called, at_us(1));
  EXPECT_EQ(log.find(12), nullptr);
}

TEST(TransmitLog, AMessageDidNotLeaveBeforeItWasSent) {
  TransmitLog log;
  log.sent(1, 100, at_us(5000));
  log.stamped(100, at_us(100));
  EXPECT_EQ(log.find(1)->left, std::nullopt);
  // Within what two readings of clocks may be apart.
  log.stamped(100, at_us(4999));
  EXPECT_EQ(log.find(1)->left, at_us(5000));
}

TEST(TransmitLog, ForgetsNumbersAndWhatIsLongAgo) {
  TransmitLog log;
  for (MessageId id = 0; id <= TransmitLog::kKept; ++id) {
    log.sent(id, static_cast<std::uint32_t>(id), at_us(1));
  }
  EXPECT_EQ(log.find(0), nullptr);
  ASSERT_NE(log.find(1), nullptr);
  log.forget_numbers();
  log.stamped(1, at_us(2));
  EXPECT_EQ(log.find(1)->left, std::nullopt);
}

}  // namespace
}  // namespace simbench::hardware
