#include "evaluation/stability/exchange_log.h"

#include <gmock/gmock.h>

#include <string>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

ExchangeLog exchanges_in(const std::string& text) { return parse_exchange_log(text, "clock.log"); }

std::string no_exchanges_in(const std::string& text) {
  try {
    exchanges_in(text);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "not refused";
}

HostTime clock_at(std::int64_t s, std::int64_t ns) {
  return HostTime(std::chrono::seconds(s) + Nanoseconds(ns));
}

// 3565350574 s since 1900 are 1356361774 since 1970.
TEST(ExchangeLog, RawstatsHaveFourStamps) {
  const ExchangeLog log = exchanges_in(
      "56285 54575.160 128.4.1.1 192.168.1.5 3565350574.400229473 3565350574.442385200 "
      "3565350574.442436000 3565350574.575154505 0 4 4 1 8 -21 0.000000 0.000320 .PPS.\n");
  EXPECT_EQ(log.format, "ntpd_rawstats");
  ASSERT_THAT(log.exchanges, SizeIs(1));
  const LoggedExchange& exchange = log.exchanges.front();
  EXPECT_EQ(exchange.server, "128.4.1.1");
  EXPECT_EQ(exchange.t1, clock_at(1356361774, 400229473));
  EXPECT_EQ(exchange.t2, clock_at(1356361774, 442385200));
  EXPECT_EQ(exchange.t3, clock_at(1356361774, 442436000));
  EXPECT_EQ(exchange.t4, clock_at(1356361774, 575154505));
  EXPECT_EQ(exchange.common_error, Nanoseconds(0));
  EXPECT_FALSE(exchange.is_estimated);
}

// A broadcast has no t1; in the other the server's stamps go back.
TEST(ExchangeLog, ExchangesWithoutAllStampsInOrderAreLeftOut) {
  const ExchangeLog log = exchanges_in(
      "56285 10.0 10.0.0.1 10.0.0.2 0.0 3565350574.4 3565350574.5 3565350574.6\n"
      "56285 11.0 10.0.0.1 10.0.0.2 3565350574.1 3565350574.5 3565350574.4 3565350574.6\n"
      "56285 12.0 10.0.0.1 10.0.0.2 3565350574.1 3565350574.2 3565350574.3 3565350574.4\n");
  EXPECT_THAT(log.exchanges, SizeIs(1));
  ASSERT_THAT(log.notes, SizeIs(1));
  EXPECT_THAT(log.notes.front(), HasSubstr("2 exchanges without all stamps"));
}

// Offset +1.5 ms (the clock is slow), delay 4 ms: the request took 2 + 1.5 ms by the two clocks,
// the reply 2 - 1.5.
TEST(ExchangeLog, MeasurementsHaveOffsetAndDelay) {
  const ExchangeLog log = exchanges_in(
      "2024-09-03 10:00:00 192.168.1.1     N  2 111 111 1111  6  6 0.00  1.500e-03  4.000e-03  "
      "1.000e-06  0.000e+00  1.000e-06 C0A80001 4B K K\n");
  EXPECT_EQ(log.format, "chrony_measurements");
  ASSERT_THAT(log.exchanges, SizeIs(1));
  const LoggedExchange& exchange = log.exchanges.front();
  EXPECT_EQ(exchange.t2 - exchange.t1, std::chrono::microseconds(3500));
  EXPECT_EQ(exchange.t4 - exchange.t3, std::chrono::microseconds(500));
  EXPECT_EQ(exchange.common_error, std::chrono::seconds(1));
  EXPECT_GE(exchange.error, std::chrono::microseconds(2));  // half of the last digit
  EXPECT_TRUE(exchange.is_estimated);
}

// The clock was 250 us ahead at the full second.
TEST(ExchangeLog, PulsesAreRawSamplesOfPps) {
  const ExchangeLog log = exchanges_in(
      "2024-09-03 10:00:07.000250 PPS  3 N 1 -2.500000e-04 -2.500000e-04  1.000e-06\n"
      "2024-09-03 10:00:08.000000 NMEA 3 N 0 -1.000000e-01 -1.000000e-01  1.000e-03\n"
      "2024-09-03 10:00:08.000250 PPS  - N -       -       -2.500000e-04  1.000e-06\n");
  EXPECT_EQ(log.format, "chrony_refclocks");
  EXPECT_TRUE(log.exchanges.empty());
  ASSERT_THAT(log.pulses, SizeIs(1));
  const LoggedPulse& pulse = log.pulses.front();
  EXPECT_EQ(pulse.source, "PPS");
  EXPECT_EQ(pulse.second, std::chrono::seconds(1725357607));
  EXPECT_EQ(pulse.read, clock_at(1725357607, 250000));
}

// The first line of a clock that began in 1970.
TEST(ExchangeLog, ClocksThatWereNotSetProveNothing) {
  const ExchangeLog log = exchanges_in(
      "56285 11.0 10.0.0.1 10.0.0.2 2208988801.0 3565350574.4 3565350574.5 2208988801.1\n"
      "56285 12.0 10.0.0.1 10.0.0.2 3565350574.1 3565350574.2 3565350574.3 3565350574.4\n");
  EXPECT_THAT(log.exchanges, SizeIs(1));
  ASSERT_THAT(log.notes, SizeIs(1));
  EXPECT_THAT(log.notes.front(), HasSubstr("1 exchange with an offset or a delay beyond 11 days"));
}

TEST(ExchangeLog, LogsOfEstimatesAreRefusedByName) {
  EXPECT_THAT(
      no_exchanges_in("2024-09-03 10:00:00 192.168.1.1      2      4.100      0.030  1.200e-06 N  "
                      "1  8.1e-07 -5.9e-08  3.7e-04  4.7e-04  9.0e-03\n"),
      testing::AllOf(HasSubstr("clock.log:1: found tracking.log of chrony"),
                     HasSubstr("allowed: ntpd's rawstats")));
  EXPECT_THAT(no_exchanges_in("ptp4l[5374018.735]: master offset -23 s2 freq +4 path delay 10\n"),
              HasSubstr("ptp4l"));
  EXPECT_THAT(no_exchanges_in("nothing\n"), HasSubstr("without an exchange"));
  EXPECT_THAT(no_exchanges_in(""), HasSubstr("without an exchange"));
}

TEST(ExchangeLog, DamagedLinesAreRefused) {
  EXPECT_THAT(
      no_exchanges_in("56285 54575.160 128.4.1.1 192.168.1.5 3565350574.4 x 3565350574.4 1\n"),
      testing::AllOf(HasSubstr("clock.log:1"), HasSubstr("stamp: found 'x'")));
  EXPECT_THAT(no_exchanges_in("56285 54575.160 128.4.1.1 192.168.1.5 3565350574.4\n"),
              HasSubstr("found 5 columns"));
}

}  // namespace
}  // namespace simbench::evaluation
