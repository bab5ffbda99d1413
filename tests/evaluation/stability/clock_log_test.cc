#include "evaluation/stability/clock_log.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/read_fault.h"
#include "tests/scratch_folder.h"

namespace simbench::evaluation {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr const char* kTracking =
    "====\n"
    "   Date (UTC) Time     IP Address   St   Freq ppm   Skew ppm     Offset L Co  Offset sd "
    "Rem. corr. Root delay Root disp. Max. error\n"
    "====\n"
    "2017-08-22 13:22:36 203.0.113.15     2     -3.541      0.075 -8.621e-06 N  2  2.940e-06 "
    "-2.084e-04  1.534e-02  3.472e-04  8.304e-03\n"
    "2017-08-22 13:22:52 203.0.113.15     2     -3.541      0.075  4.5e-06 N  2  2.940e-06 "
    "-2.084e-04  1.534e-02  3.472e-04  8.304e-03\n"
    "2017-08-22 13:23:00 0.0.0.0          0     -3.541      0.075  0.000e+00 ?  0  0.000e+00 "
    "0.000e+00  1.0  1.0  1.0\n";

constexpr const char* kStatistics =
    "   Date (UTC) Time     IP Address    Std dev'n Est offset  Offset sd  Diff freq   Est skew  "
    "Stress  Ns  Bs  Nr  Asym\n"
    "2016-08-10 05:40:50 203.0.113.15     6.261e-03 -3.247e-03  2.220e-03  1.874e-06  1.080e-06 "
    "7.8e-02  16   0   8  0.00\n"
    "2016-08-10 05:41:54 203.0.113.15     6.261e-03  2.000e-03  2.220e-03  1.874e-06  1.080e-06 "
    "7.8e-02  16   0   8  0.00\n";

constexpr const char* kPtp4l =
    "ptp4l[5374018.735]: port 1: UNCALIBRATED to SLAVE on MASTER_CLOCK_SELECTED\n"
    "ptp4l[5374019.735]: master offset     -36205 s1 freq      +0 path delay     10623\n"
    "ptp4l[5374020.736]: master offset        -23 s2 freq  -30575 path delay     10286\n";

constexpr const char* kPhc2sys =
    "Jan  2 03:04:05 box phc2sys: [100.001] eth0 is a boundary clock\n"
    "Jan  2 03:04:05 box phc2sys: [101.001] CLOCK_REALTIME phc offset        12 s2 freq   +900 "
    "delay   512\n"
    "Jan  2 03:04:06 box kernel: something\n"
    "Jan  2 03:04:06 box phc2sys[77]: [102.001] CLOCK_REALTIME phc offset       -12 s2 freq +900\n";

constexpr const char* kLoopstats =
    "50935 75440.031 0.000006019 13.778190 0.000351733 0.013380 6\n"
    "50935 75504.031 -0.000006019 13.778190 0.000351733 0.013380 6\n";

ClockLog parsed(const std::string& text, const ClockLogOptions& options = {}) {
  return parse_clock_log(text, "log", options);
}

std::vector<double> errors(const ClockLog& log) {
  std::vector<double> found;
  for (const ClockLogPoint& point : log.points) found.push_back(point.error_s);
  return found;
}

std::vector<double> seconds(const ClockLog& log) {
  std::vector<double> found;
  for (const ClockLogPoint& point : log.points) {
    found.push_back(static_cast<double>(point.time.count()) / 1e6);
  }
  return found;
}

// The message about a text that is no log.
std::string problem(const std::string& text, const ClockLogOptions& options = {}) {
  try {
    parsed(text, options);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << text;
  return {};
}

TEST(ClockLog, ReadsTables) {
  const ClockLog plain = parsed("# a comment\n0,1e-6\n0.5, -2e-6\r\n\n1.000001,+0.25\n");
  EXPECT_EQ(plain.format, "csv");
  EXPECT_THAT(seconds(plain), ElementsAre(0, 0.5, 1.000001));
  EXPECT_THAT(errors(plain), ElementsAre(1e-6, -2e-6, 0.25));
  EXPECT_THAT(plain.notes,
              ElementsAre(HasSubstr("times are taken as s: no heading"),
                          HasSubstr("time errors are taken as s, by their size: no heading")));
  EXPECT_THAT(errors(parsed("\xef\xbb\xbftime_s,error_us\n1,5\n")), ElementsAre(5 * 1e-6));
  EXPECT_THAT(errors(parsed("\"t\",\"TE [ns]\"\n1,5\n")), ElementsAre(5 * 1e-9));
  EXPECT_THAT(errors(parsed("t,error\n1,5\n", {.unit = kMillisecondUnit})), ElementsAre(5 * 1e-3));
  EXPECT_THAT(errors(parsed("t,error_ms\n1,5\n", {.unit = kMillisecondUnit})),
              ElementsAre(5 * 1e-3));
}

TEST(ClockLog, AUnitIsNeverAssumedInSilence) {
  for (const char* heading : {"offset_NS", "offset_nsec", "offsetNs", "offset (ns)", "offset:ns"}) {
    const ClockLog log = parsed(std::string("time_s,") + heading + "\n0,64\n1,-24\n");
    EXPECT_THAT(errors(log), ElementsAre(64 * 1e-9, -24 * 1e-9)) << heading;
    EXPECT_THAT(log.notes, IsEmpty()) << heading;
  }
  EXPECT_THAT(errors(parsed("time (s),offset (µs)\n0,64\n")), ElementsAre(64 * 1e-6));
  EXPECT_THAT(errors(parsed("time_s,offset_ps\n0,64\n")), ElementsAre(64 * 1e-12));
  EXPECT_THAT(errors(parsed("# time_s,offset_ns\n0.0e0,6.4e+01\n")), ElementsAre(64 * 1e-9));
  EXPECT_THAT(seconds(parsed("elapsed_msec,te_ns\n1000,1\n2000,2\n")), ElementsAre(1, 2));
  EXPECT_THAT(seconds(parsed("time_ns,offset_ns\n1725359542000000000,64\n")),
              ElementsAre(1725359542));
  const ClockLog sized = parsed("t,x_ns\n1725359542500,64\n");
  EXPECT_THAT(seconds(sized), ElementsAre(1725359542.5));
  EXPECT_THAT(sized.notes, ElementsAre(HasSubstr("taken as ms since 1970, by their size")));
  EXPECT_THAT(seconds(parsed("t,x_ns\n2024-09-03T10:32:22.25Z,64\n")), ElementsAre(1725359542.25));
  for (const char* text : {"time,offset\n0,64\n1,-24\n", "0,64\n1,-24\n", "0,0.5\n1,0.25\n"}) {
    EXPECT_THAT(problem(text), AllOf(HasSubstr("found no unit of the time errors"),
                                     HasSubstr("--unit with one of s, ms, us, ns, ps")));
  }
}

TEST(ClockLog, CellsWithoutAValueAreGapsThatAreCounted) {
  const ClockLog log = parsed("time_s,offset_ns\n0,1\n1,\n2,NaN\n3,4\n");
  EXPECT_THAT(seconds(log), ElementsAre(0, 3));
  EXPECT_THAT(log.notes,
              ElementsAre("log: 2 rows without a value, the first in line 3: each is a gap"));
}

TEST(ClockLog, ATableOfOneColumnNeedsTheInterval) {
  const std::string phase = "# phase data, unit: ns\n1\n3\n2\n";
  const ClockLog log = parsed(phase, {.interval_s = 2.0});
  EXPECT_THAT(seconds(log), ElementsAre(0, 2, 4));
  EXPECT_THAT(errors(log), ElementsAre(1e-9, 3 * 1e-9, 2 * 1e-9));
  EXPECT_THAT(problem(phase), HasSubstr("found one column of values, allowed: two"));
  const ClockLog sums = parsed("1e-9\n-3e-9\n", {.interval_s = 2.0, .frequencies = true});
  EXPECT_THAT(seconds(sums), ElementsAre(0, 2, 4));
  EXPECT_THAT(errors(sums), ElementsAre(0, 2e-9, testing::DoubleEq(-4e-9)));
}

TEST(ClockLog, TakesTheNamedColumnOfATable) {
  const std::string text = "t,a_ms,b_s\n1,2,3\n2,4,6\n";
  EXPECT_THAT(errors(parsed(text, {.series = "b_s"})), ElementsAre(3, 6));
  EXPECT_THAT(errors(parsed(text, {.series = "a_ms"})), ElementsAre(2e-3, 4e-3));
  EXPECT_THAT(errors(parsed(text, {.series = "3"})), ElementsAre(3, 6));
  EXPECT_THAT(errors(parsed("1,2,3\n", {.unit = kSecondUnit, .series = "3"})), ElementsAre(3));
  EXPECT_THAT(problem(text), AllOf(HasSubstr("log:1: found 3 columns of values, allowed: two"),
                                   HasSubstr("'a_ms', 'b_s'")));
  EXPECT_THAT(problem(text, {.series = "c"}), HasSubstr("--series: found 'c', allowed: the name"));
  EXPECT_THAT(problem(text, {.series = "1"}), HasSubstr("its number up to 3"));
}

TEST(ClockLog, ReadsTheLogsOfChrony) {
  const ClockLog tracking = parsed(kTracking);
  EXPECT_EQ(tracking.format, "chrony_tracking");
  EXPECT_THAT(errors(tracking), ElementsAre(-8.621e-06, 4.5e-06));
  EXPECT_THAT(seconds(tracking), ElementsAre(1503408156, 1503408172));
  EXPECT_THAT(tracking.notes, ElementsAre("log: 1 line of an unsynchronised clock left out"));
  const ClockLog statistics = parsed(kStatistics);
  EXPECT_EQ(statistics.format, "chrony_statistics");
  EXPECT_THAT(errors(statistics), ElementsAre(-3.247e-03, 2e-3));
  EXPECT_THAT(seconds(statistics), ElementsAre(1470807650, 1470807714));
  // Without the heading, by the columns.
  for (const std::string text : {kTracking, kStatistics}) {
    EXPECT_EQ(parsed(text.substr(text.find("\n2") + 1)).format, parsed(text).format);
  }
}

TEST(ClockLog, ReadsWhatLinuxptpPrints) {
  const ClockLog ptp4l = parsed(kPtp4l);
  EXPECT_EQ(ptp4l.format, "ptp4l");
  EXPECT_THAT(errors(ptp4l), ElementsAre(1e-9 * -36205, 1e-9 * -23));
  EXPECT_THAT(seconds(ptp4l), ElementsAre(5374019.735, 5374020.736));
  EXPECT_THAT(
      ptp4l.notes,
      ElementsAre("log: 1 point before the servo locked (s0, s1) among those taken; --locked "
                  "leaves them out"));
  EXPECT_THAT(errors(parsed(kPtp4l, {.locked = true})), ElementsAre(1e-9 * -23));
  const ClockLog phc2sys = parsed(kPhc2sys);
  EXPECT_EQ(phc2sys.format, "phc2sys");
  EXPECT_THAT(errors(phc2sys), ElementsAre(1e-9 * 12, 1e-9 * -12));
  EXPECT_THAT(seconds(phc2sys), ElementsAre(101.001, 102.001));
  EXPECT_THAT(phc2sys.notes, ElementsAre("log: 1 line of other programs left out"));
}

TEST(ClockLog, TurnsTheSignOfNtpd) {
  const ClockLog log = parsed(kLoopstats);
  EXPECT_EQ(log.format, "loopstats");
  EXPECT_THAT(errors(log), ElementsAre(-0.000006019, 0.000006019));
  EXPECT_THAT(seconds(log), ElementsAre((50935 - 40587) * 86400.0 + 75440.031,
                                        (50935 - 40587) * 86400.0 + 75504.031));
}

TEST(ClockLog, ReadsTheOtherLogsOfChrony) {
  const ClockLog refclocks = parsed(
      "====\n   Date (UTC) Time         Refid  DP L P  Raw offset   Cooked offset      Disp.\n"
      "2019-09-05 06:10:00.000123 PPS    0 N 1  6.400000e-08  6.5e-08  1.000e-07\n"
      "2019-09-05 06:10:01.000123 PPS    - N -       -        6.5e-08  1.000e-07\n");
  EXPECT_EQ(refclocks.format, "chrony_refclocks");
  EXPECT_THAT(errors(refclocks), ElementsAre(-6.4e-08));
  EXPECT_THAT(refclocks.notes, ElementsAre(HasSubstr("1 filtered sample left out")));
  const ClockLog measurements = parsed(
      "2016-11-09 05:40:50 203.0.113.15    N  2 111 111 1111  10 10 1.0  -4.966e-03  2.296e-01  "
      "1.577e-05  1.615e-01  7.446e-03 CB00717B 4B D K\n"
      "2016-11-09 05:40:52 203.0.113.15    N  2 111 110 1111  10 10 1.0  -9e-03  2.296e-01  "
      "1.577e-05  1.615e-01  7.446e-03 CB00717B 4B D K\n");
  EXPECT_EQ(measurements.format, "chrony_measurements");
  EXPECT_THAT(errors(measurements), ElementsAre(4.966e-03));
  EXPECT_THAT(measurements.notes, ElementsAre(HasSubstr("1 measurement that chronyd's tests")));
  const ClockLog tracking = parsed(
      "CB00710F,203.0.113.15,2,1725359542.5,0.000001000,-0.000002000,0.1,-3.5,0.0,0.1,0.01,0.001,"
      "64.2,Normal\n"
      "CB00710F,203.0.113.15,2,1725359542.5,0.000001100,-0.000002000,0.1,-3.5,0.0,0.1,0.01,0.001,"
      "64.2,Normal\n"
      "CB00710F,203.0.113.15,2,1725359606.5,0.000001000,0.000003000,0.1,-3.5,0.0,0.1,0.01,0.001,"
      "64.2,Normal\n");
  EXPECT_EQ(tracking.format, "chronyc_tracking");
  EXPECT_THAT(errors(tracking), ElementsAre(-2e-6, 3e-6));
  EXPECT_THAT(seconds(tracking), ElementsAre(1725359542.5, 1725359606.5));
}

TEST(ClockLog, AHeadingMayBeLongerThanItsRows) {
  EXPECT_THAT(errors(parsed("time_s,offset_ns,port\n0,1\n1,2\n")), ElementsAre(1e-9, 2e-9));
  EXPECT_THAT(problem("time_s,offset_ns,freq_ns\n0,1\n1,2\n", {.series = "freq_ns"}),
              HasSubstr("--series: found 'freq_ns'"));
}

TEST(ClockLog, FrequenciesOfSeveralSeriesAreRefused) {
  EXPECT_THAT(problem("time_s,y,host\n0,1e-9,a\n1,1e-9,a\n", {.frequencies = true}),
              HasSubstr("allowed with --frequencies: one series"));
}

// One value that is damaged among small ones, whose unit is found by their size.
TEST(ClockLog, AnErrorThatNoClockHasIsRefusedWhateverTheUnit) {
  const std::string text = "1e-7\n2e-7\n1e-7\n2e15\n1e-7\n";
  EXPECT_THAT(problem(text, {.interval_s = 1}), HasSubstr("found a time error of 2e+15 s"));
  EXPECT_THAT(problem(text, {.unit = kSecondUnit, .interval_s = 1}),
              HasSubstr(":4: time error: found '2e15'"));
}

// NtpOffset is what has to be added to the local clock; FILETIME counts 100 ns from 1601.
TEST(ClockLog, W32tmsTableOfProcessorCounts) {
  const ClockLog log = parsed(
      "Tracking time.example [192.0.2.1:123].\n"
      "RdtscStart, RdtscEnd, FileTime, RoundtripDelay, NtpOffset\n"
      "1064318923946, 1064319045318, 130852169372513840, 00.0396100, +00.0014513\n"
      "1064338923946, 1064339045318, 130852169392513840, 00.0396100, -00.0000025\r\n");
  EXPECT_EQ(log.format, "w32tm");
  EXPECT_THAT(errors(log), ElementsAre(-0.0014513, 2.5e-6));
  EXPECT_THAT(seconds(log), ElementsAre(1440743337.251384, 1440743339.251384));
}

// The pulse of a clock that is ahead comes early.
TEST(ClockLog, ATiccsStampsAreTheErrorsOfTheirPulses) {
  const std::string text =
      "# timestamp (seconds)\n100000017.123456789012 chA\n100000017.500000000000 chB\n"
      "100000018.123456789000 chA\n100000018.500000000250 chB\n"
      "100000020.123456789112 chA\n100000019.900000000000 chB\n";
  const ClockLog fast = parsed(text, {.series = "chA"});
  ASSERT_EQ(fast.points.size(), 3U);
  EXPECT_EQ(fast.points[0].error_s, 0);
  EXPECT_NEAR(fast.points[1].error_s, 12e-12, 1e-16);
  EXPECT_NEAR(fast.points[2].error_s, -100e-12, 1e-16);
  const ClockLog late = parsed(text, {.series = "chB"});
  ASSERT_EQ(late.points.size(), 2U);
  EXPECT_NEAR(late.points[1].error_s, -250e-12, 1e-16);
  EXPECT_THAT(late.notes, testing::Contains(HasSubstr("1 pulse more than 0.25 s")));
}

TEST(ClockLog, ReadsWhatOtherProgramsPrint) {
  const std::string peers =
      "60200 80000.031 127.127.28.0 961a 0.000022910 0.0 0.000251573 0.000090312\n"
      "60200 80004.031 192.0.2.1 9014 0.000112910 0.0004 0.004083086 0.000082440\n";
  EXPECT_THAT(errors(parsed(peers, {.series = "127.127.28.0"})), ElementsAre(-0.000022910));
  EXPECT_THAT(problem(peers), HasSubstr("found 2 series, '127.127.28.0', '192.0.2.1'"));
  const ClockLog sntp = parsed(
      "2018-09-29 19:00:00.5 (-0200) +0.000064 +/- 0.018 pool.example 192.0.2.36 s2 no-leap\n");
  EXPECT_THAT(errors(sntp), ElementsAre(-0.000064));
  EXPECT_THAT(seconds(sntp), ElementsAre(1538254800.5)) << "21:00 UTC";
  const ClockLog pps = parsed(
      "ntpshmmon version 1\n#      Name Seen@  Clock  Real  L Prec\n"
      "sample NTP2 1579299789.000814106 1579299789.000017504 1579299789.000000000 0 -30\n");
  EXPECT_THAT(errors(pps), ElementsAre(17504e-9));
  const ClockLog windows = parsed(
      "Tracking time.example [192.0.2.1:123].\r\nCollecting 3 samples.\r\n"
      "23:59:59, +0000.0000640s\r\n00:00:01, error: 0x800705B4\r\n"
      "00:00:03, d:+00.0001s o:-00.0000240s  [  *  ]\r\n");
  EXPECT_THAT(errors(windows), ElementsAre(-64e-6, 24e-6));
  EXPECT_THAT(seconds(windows), ElementsAre(86399, 86403));
  const ClockLog timesyncd = parsed(
      "Sep 03 10:32:22 node1 systemd-timesyncd[412]: interval/delta/delay/jitter/drift "
      "64s/+0.002s/0.012s/0.000s/+12ppm\n");
  EXPECT_THAT(errors(timesyncd), ElementsAre(-0.002));
  const ClockLog ptpd = parsed(
      "# Timestamp, State, Clock ID, One Way Delay, Offset From Master\n"
      "2014-03-12 12:34:56.5, init, \n"
      "2014-03-12 12:34:56.5, slv, 001122fffe334455(unknown)/1, 0.000012345, -0.000000123, 0\n");
  EXPECT_THAT(errors(ptpd), ElementsAre(-123e-9));
}

TEST(ClockLog, ReadsLinuxptpBehindEveryHead) {
  const std::vector<std::string> heads = {
      "ptp4l[3906.052]: ",
      "Sep 03 10:32:22 node1 ptp4l[263]: [3906.052] ",
      "Sep 03 10:32:22 node1 ptp4l: [3906.052] ",
      "Sep 03 10:32:22 node1 ptp4l[263]: ptp4l[3906.052]: ",
      "2024-09-03T10:32:22+0000 node1 ptp4l[263]: [3906.052] ",
      "2024-09-03T10:32:22.123456789Z stdout F ptp4l[3906.052]: ",
      "ptp4l-1  | ptp4l[3906.052]: ",
      "ptp4l[3906.052]: [ptp4l.0.config:6] ",
      "[3906.052] "};
  for (const std::string& head : heads) {
    const ClockLog log =
        parsed("-- Journal begins at Tue --\nSep 03 10:32:20 n systemd[1]: Started\n" + head +
               "master offset         64 s2 freq  -25211 path delay  635\n");
    EXPECT_EQ(log.format, "ptp4l") << head;
    EXPECT_THAT(errors(log), ElementsAre(1e-9 * 64)) << head;
    EXPECT_THAT(seconds(log), ElementsAre(3906.052)) << head;
  }
  const std::string json =
      R"({"__CURSOR":"s=1","_HOSTNAME":"n","SYSLOG_IDENTIFIER":"ptp4l","_PID":"263","MESSAGE":"[3906.052] master offset 64 s2 freq -25211 path delay 635"})"
      "\n";
  EXPECT_THAT(errors(parsed(json)), ElementsAre(1e-9 * 64));
  const std::string docker =
      R"({"log":"ptp4l[3906.052]: master offset 64 s2 freq -1 path delay 6\n","stream":"stdout"})"
      "\n";
  EXPECT_THAT(errors(parsed(docker)), ElementsAre(1e-9 * 64));
  const std::string exported =
      "__CURSOR=s=1\n_HOSTNAME=n\nMESSAGE=[3906.052] master offset 64 s2 freq -1 path delay 6\n"
      "SYSLOG_IDENTIFIER=ptp4l\n_PID=263\n\n";
  EXPECT_THAT(errors(parsed(exported)), ElementsAre(1e-9 * 64));
  EXPECT_EQ(parsed("ts2phc[104210.488]: nmea delay: 147943835 ns\n"
                   "ts2phc[104210.488]: eth0 master offset 12 s2 freq +1\n")
                .format,
            "ts2phc");
}

TEST(ClockLog, SummariesHaveNoSeries) {
  const ClockLog log = parsed(
      "ptp4l[257.093]: rms   67 max   73 freq +14358 +/-   5 delay   241 +/-   0\n"
      "ptp4l[258.093]: rms   27 max   33 freq +14358 +/-   5 delay   241 +/-   0\n");
  EXPECT_TRUE(log.are_summaries());
  EXPECT_THAT(errors(log), ElementsAre(67 * 1e-9, 27 * 1e-9));
  EXPECT_THAT(log.largest_s, ElementsAre(73 * 1e-9, 33 * 1e-9));
}

TEST(ClockLog, SeveralSeriesNeedAName) {
  const std::string sources = std::string(kStatistics) +
                              "2016-08-10 05:41:55 PPS0 6.2e-03 7.000e-03  2.2e-03 1e-06 1e-06 "
                              "7.8e-02  16   0   8  0.00\n";
  EXPECT_THAT(problem(sources), AllOf(HasSubstr("found 2 series, '203.0.113.15', 'PPS0', allowed"),
                                      HasSubstr("--series")));
  EXPECT_THAT(errors(parsed(sources, {.series = "PPS0"})), ElementsAre(7e-3));
  EXPECT_THAT(problem(sources, {.series = "GPS"}),
              HasSubstr("--series: found 'GPS', which is none of the series, allowed: "
                        "'203.0.113.15', 'PPS0'"));
  const std::string clocks =
      "phc2sys[1.0]: CLOCK_REALTIME phc offset 1 s2 freq +1\n"
      "phc2sys[1.1]: eth1 sys offset 2 s2 freq +1\n";
  EXPECT_THAT(problem(clocks), HasSubstr("found 2 series, 'CLOCK_REALTIME phc', 'eth1 sys'"));
  EXPECT_THAT(errors(parsed(clocks, {.series = "eth1 sys"})), ElementsAre(1e-9 * 2));
}

TEST(ClockLog, ProcessesAndHostsAreSeries) {
  const auto line = [](const char* host, int process, double at_s, int offset_ns) {
    return fmt::format("Sep 03 10:32:22 {} ptp4l[{}]: [{:.3f}] master offset {} s2 freq -1\n", host,
                       process, at_s, offset_ns);
  };
  std::string two;
  std::string hosts;
  std::string restarted;
  for (int i = 0; i < 4; ++i) {
    two += line("n1", 700, 10 + i, i) + line("n1", 701, 10.5 + i, 1000 + i);
    hosts += line("n1", 700, 10 + i, i) + line("n2", 700, 10.5 + i, 1000 + i);
  }
  for (int i = 0; i < 4; ++i) restarted += line("n1", i < 2 ? 263 : 251, i < 2 ? 500 + i : i, i);
  EXPECT_THAT(problem(two), HasSubstr("found 2 series, 'ptp4l[700]', 'ptp4l[701]'"));
  EXPECT_THAT(errors(parsed(two, {.series = "701"})), SizeIs(4));
  EXPECT_THAT(errors(parsed(two, {.series = "ptp4l[700]"})).back(), 1e-9 * 3);
  EXPECT_THAT(problem(hosts), HasSubstr("found 2 series, 'n1', 'n2'"));
  EXPECT_THAT(errors(parsed(hosts, {.series = "n2"})), SizeIs(4));
  const ClockLog one = parsed(restarted);
  EXPECT_THAT(one.points, SizeIs(4));
  EXPECT_THAT(one.segments, ElementsAre(2));
  EXPECT_THAT(one.notes, ElementsAre(HasSubstr("times go back 1 time (a restart")));
}

TEST(ClockLog, RotatedFilesAreInAnyOrder) {
  const std::string rotated =
      "50936 10 0.3 1 1 1\n50936 26 0.4 1 1 1\n50935 10 0.1 1 1 1\n50935 26 0.2 1 1 1\n";
  const ClockLog log = parsed(rotated);
  EXPECT_THAT(errors(log), ElementsAre(-0.1, -0.2, -0.3, -0.4));
  EXPECT_THAT(log.segments, IsEmpty());
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("put in order of time")));
}

TEST(ClockLog, LinesOfOthersAreCounted) {
  const ClockLog log = parsed(std::string(kLoopstats) + "hello\n\n50935 75600 0.1 1 1 1\n");
  EXPECT_THAT(errors(log), SizeIs(3));
  EXPECT_THAT(log.notes,
              ElementsAre("log:3: 1 line that is no measurement left out, the first here"));
}

TEST(ClockLog, RefusesOtherPrograms) {
  for (const char* text : {"hello world\n", "{\"a\": 1}\n"}) {
    EXPECT_THAT(problem(text), AllOf(StartsWith("log:1: found "), HasSubstr("allowed: a table")));
  }
  EXPECT_THAT(problem("Name/IP Address            NP  NR  Span  Frequency  Freq Skew  Offset  Std "
                      "Dev\n17:11:00 ntp1   16  10    15  -0.830  0.855  +6us  4215ns\n"),
              AllOf(HasSubstr("log:1: found chronyc sourcestats"), HasSubstr("statistics.log")));
  EXPECT_THAT(problem("   Date (UTC) Time    Temp   Comp\n2015-04-19 10:39:48 2.8e+04 3.6e-01\n"),
              HasSubstr("another log of chronyd; allowed: its tracking.log"));
}

TEST(ClockLog, RefusesOtherUnits) {
  EXPECT_THAT(
      problem(kTracking, {.unit = kMillisecondUnit}),
      AllOf(HasSubstr("--unit: found tracking.log of chrony"), HasSubstr("allowed: with tables")));
  EXPECT_THAT(problem("t,error_us\n0,1\n", {.unit = kNanosecondUnit}),
              HasSubstr("log:1: --unit: found 'ns', allowed: us, which the column 'error_us'"));
  EXPECT_THAT(problem("t_ms,error_us\n0,1\n", {.time_unit = kSecondUnit}),
              HasSubstr("--time-unit: found 's', allowed: ms, which the column 't_ms' states"));
  EXPECT_THAT(problem("ptp4l[1.5]: master offset 12.5 s2 freq +1\n"
                      "ptp4l[1.6]: master offset 12 s2 freq +1\n"),
              HasSubstr("log:1: offset: found '12.5', allowed: whole nanoseconds"));
}

TEST(ClockLog, RefusesWhatIsDamaged) {
  const ClockLogOptions seconds{.unit = kSecondUnit};
  EXPECT_THAT(problem(""), HasSubstr("log:1: the file is empty"));
  EXPECT_THAT(problem("\n\n"), HasSubstr("log:1: the file is empty"));
  EXPECT_THAT(problem("0,1\n1,2,3\n", seconds), HasSubstr("log:2: found 3 cells, allowed: 2"));
  EXPECT_THAT(problem("0,1\n1\n2,3\n3,4\n", seconds),
              HasSubstr("log:2: found 1 cells, allowed: 2"));
  EXPECT_THAT(problem("0,1\nx,2\n", seconds),
              HasSubstr("log:2: time: found 'x', allowed: a number of s"));
  for (const char* number : {"inf", "-inf", "1e400", "2e10", "1x", "0x1p3", "++1", "+-1"}) {
    EXPECT_THAT(problem(std::string("0,1\n1,") + number + "\n", seconds),
                HasSubstr("allowed: a number up to 1e+10"))
        << number;
  }
  EXPECT_THAT(problem("0,1\n1e300,1\n", seconds), HasSubstr("log:2: time: found '1e300'"));
  const std::string tracking = kTracking;
  EXPECT_THAT(problem(tracking + "2017-08-22 13:24:00 203.0.113.15 2 -3.5\n"),
              HasSubstr("log:7: found 5 columns, allowed: at least 9"));
  EXPECT_THAT(problem("50935 75440.031 0.1 1\n50935 75441 0.1 1 1 1\n"),
              HasSubstr("found 4 columns, allowed: 5 to 7"));
  EXPECT_THAT(problem("50935 99999 0.1 1 1\n50935 99 0.1 1 1\n"),
              HasSubstr("second: found '99999'"));
  EXPECT_THAT(problem(std::string(kPtp4l) + "ptp4l[12]: master offset 12 s2\n"),
              HasSubstr("log:4: time: found 'master offset 12 s2'"));
}

TEST(ClockLog, NotesALastLineThatMayBeCut) {
  const ClockLog log = parsed("t_s,x_s\n0,1\n1,2\n2,3");
  EXPECT_THAT(errors(log), ElementsAre(1, 2));
  EXPECT_THAT(log.notes, ElementsAre(HasSubstr("the last line has no line end")));
  EXPECT_THAT(problem("0,1"), HasSubstr("ends without a time error"));
  EXPECT_THAT(parsed(std::string(kPtp4l) + "ptp4l[1").notes,
              testing::Contains(StartsWith("log:4: the last line has no line end")));
}

TEST(ClockLog, AFileIsReadWholeOrRefused) {
  const ScratchFolder folder;
  const std::string file = folder.write("tracking.log", kTracking);
  EXPECT_THAT(read_clock_log(file).points, SizeIs(2));
  const std::size_t size = std::string(kTracking).size();
  for (std::size_t byte = 0; byte < size; byte += 7) {
    const ReadFault fault(byte);
    EXPECT_THROW(read_clock_log(file), scenarios::InputError) << byte;
  }
  EXPECT_THROW(read_clock_log(folder / "absent.log"), scenarios::InputError);
  EXPECT_THROW(read_clock_log(folder.path().string()), scenarios::InputError);
}

TEST(ClockLog, EveryCutOfEveryFormatIsReadOrRefused) {
  for (const std::string text : {kTracking, kStatistics, kPtp4l, kPhc2sys, kLoopstats}) {
    for (std::size_t end = 0; end < nonempty(text).size(); ++end) {
      for (const std::string& cut : {text.substr(0, end), text.substr(0, end) + "\n"}) {
        try {
          EXPECT_THAT(parsed(cut).points, testing::Not(IsEmpty()));
        } catch (const scenarios::InputError& error) {
          EXPECT_THAT(error.what(), StartsWith("log:"));
        }
      }
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
