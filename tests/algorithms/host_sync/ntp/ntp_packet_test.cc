#include <gtest/gtest.h>

#include <random>

#include "algorithms/host_sync/ntp/ntp_association.h"

namespace simbench {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kUnixSecondsOfEra1 = 2'085'978'496;  // 7 February 2036, 06:28:16 UTC

HostTime unix_time(std::int64_t seconds, std::int64_t ns = 0) {
  return HostTime(Nanoseconds(seconds * kSecond + ns));
}

TEST(NtpTimestamp, CountsSecondsSince1900) {
  EXPECT_EQ(to_ntp(unix_time(0)), (NtpTimestamp{2'208'988'800U, 0}));
  EXPECT_EQ(to_ntp(unix_time(0, 500'000'000)), (NtpTimestamp{2'208'988'800U, 0x80000000U}));
  EXPECT_EQ(to_ntp(unix_time(-1, 750'000'000)), (NtpTimestamp{2'208'988'799U, 0xC0000000U}));
}

TEST(NtpTimestamp, WrapsAtTheEra) {
  EXPECT_EQ(to_ntp(unix_time(kUnixSecondsOfEra1 - 1)), (NtpTimestamp{0xFFFFFFFFU, 0}));
  EXPECT_EQ(to_ntp(unix_time(kUnixSecondsOfEra1)), (NtpTimestamp{0, 0}));
}

TEST(NtpTimestamp, MeansTheInstantNearestToTheGivenOne) {
  const HostTime before = unix_time(kUnixSecondsOfEra1 - 10, 123);
  const HostTime after = unix_time(kUnixSecondsOfEra1 + 10, 456);
  EXPECT_EQ(from_ntp(to_ntp(after), before), after);
  EXPECT_EQ(from_ntp(to_ntp(before), after), before);
  const std::int64_t years_67 = std::int64_t{67} * 365 * 86400;
  EXPECT_EQ(from_ntp(to_ntp(before), before + Nanoseconds(years_67 * kSecond)), before);
  EXPECT_EQ(from_ntp(to_ntp(before), before - Nanoseconds(years_67 * kSecond)), before);
}

TEST(NtpTimestamp, KeepsEveryNanosecond) {
  constexpr std::uint64_t kSeed = 5905;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200'000; ++i) {
    const auto seconds = static_cast<std::int64_t>(random() % 4'000'000'000U) - 1'000'000'000;
    const auto ns = i == 0 ? kSecond - 1 : static_cast<std::int64_t>(random() % kSecond);
    const HostTime time = unix_time(seconds, ns);
    ASSERT_EQ(from_ntp(to_ntp(time), time + from_ms(3600e3)), time)
        << "seed " << kSeed << ", round " << i;
  }
}

TEST(NtpPacket, TheBytesAreThoseOfTheRfc) {
  NtpPacket packet;
  packet.leap = 1;
  packet.version = 3;
  packet.mode = kNtpModeServer;
  packet.stratum = 2;
  packet.poll = 10;
  packet.precision = -23;
  packet.root_delay = 0x01020304;
  packet.root_dispersion = 0x05060708;
  packet.reference_id = 0x4C4F434C;
  packet.reference = {0x10, 0x20};
  packet.origin = {0x30, 0x40};
  packet.receive = {0x50, 0x60};
  packet.transmit = {0xAABBCCDD, 0x11223344};
  const Bytes bytes = encode(packet);
  const unsigned char expected[kNtpPacketBytes] = {
      0x5C, 2, 10, 0xE9, 1, 2, 3, 4,    5,    6,    7,    8,    'L',  'O',  'C',  'L',
      0,    0, 0,  0x10, 0, 0, 0, 0x20, 0,    0,    0,    0x30, 0,    0,    0,    0x40,
      0,    0, 0,  0x50, 0, 0, 0, 0x60, 0xAA, 0xBB, 0xCC, 0xDD, 0x11, 0x22, 0x33, 0x44};
  ASSERT_EQ(bytes.size(), kNtpPacketBytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<unsigned char>(bytes[i]), expected[i]) << "byte " << i;
  }
  EXPECT_EQ(decode_ntp_packet(bytes), packet);
}

TEST(NtpPacket, OtherLengthsAndVersionsAreRefused) {
  const Bytes request = encode(NtpPacket{});
  for (std::size_t size = 0; size <= 100; ++size) {
    Bytes bytes = request;
    bytes.resize(size);
    EXPECT_EQ(decode_ntp_packet(bytes).has_value(), size == kNtpPacketBytes) << size;
  }
  for (int version = 0; version < 8; ++version) {
    Bytes bytes = request;
    bytes[0] = static_cast<std::byte>(version << 3 | 3);
    EXPECT_EQ(decode_ntp_packet(bytes).has_value(), version >= 1 && version <= 4) << version;
  }
}

TEST(NtpPacket, WhateverIsDecodedEncodesToTheSameBytes) {
  constexpr std::uint64_t kSeed = 4330;
  std::mt19937_64 random(kSeed);
  int accepted = 0;
  for (int i = 0; i < 100'000; ++i) {
    Bytes bytes(kNtpPacketBytes);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    const auto packet = decode_ntp_packet(bytes);
    if (!packet) continue;
    ++accepted;
    ASSERT_EQ(encode(*packet), bytes) << "seed " << kSeed << ", round " << i;
  }
  EXPECT_NEAR(accepted, 50'000, 2'000) << "seed " << kSeed;  // versions 1 to 4 of 0 to 7
}

TEST(ClockOffset, IsTheServerMinusTheClientForEqualDelays) {
  // The server is 700 ms ahead; 3 ms there, 2 ms in the server, 3 ms back.
  const HostTime t1 = unix_time(100);
  const HostTime t2 = t1 + from_ms(703);
  const HostTime t3 = t2 + from_ms(2);
  const HostTime t4 = t1 + from_ms(8);
  EXPECT_EQ(clock_offset(t1, t2, t3, t4), from_ms(700));
}

TEST(ClockOffset, TakesHalfOfTheAsymmetry) {
  // Clocks agree; 5 ms there and 1 ms back.
  const HostTime t1 = unix_time(100);
  EXPECT_EQ(clock_offset(t1, t1 + from_ms(5), t1 + from_ms(5), t1 + from_ms(6)), from_ms(2));
}

TEST(ClockOffset, CrossesTheEra) {
  const HostTime t1 = unix_time(kUnixSecondsOfEra1 - 1);
  const HostTime t2 = from_ntp(to_ntp(t1 + from_ms(4001)), t1);
  const HostTime t3 = from_ntp(to_ntp(t2), t1);
  EXPECT_EQ(clock_offset(t1, t2, t3, t1 + from_ms(2)), from_ms(4000));
}

}  // namespace
}  // namespace simbench
