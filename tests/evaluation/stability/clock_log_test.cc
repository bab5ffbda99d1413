#include "evaluation/stability/clock_log.h"

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

TEST(ClockLog, ReadsCsv) {
  const ClockLog plain = parsed("# a comment\n0,1e-6\n0.5, -2e-6\r\n\n1.000001,+0.25\n");
  EXPECT_EQ(plain.format, "csv");
  EXPECT_THAT(seconds(plain), ElementsAre(0, 0.5, 1.000001));
  EXPECT_THAT(errors(plain), ElementsAre(1e-6, -2e-6, 0.25));
  EXPECT_THAT(plain.notes, IsEmpty());
  EXPECT_THAT(errors(parsed("\xef\xbb\xbftime_s,error_us\n1,5\n")), ElementsAre(5 * 1e-6));
  EXPECT_THAT(errors(parsed("\"t\",\"TE [ns]\"\n1,5\n")), ElementsAre(5 * 1e-9));
  EXPECT_THAT(errors(parsed("t,error\n1,5\n", {.unit = ErrorUnit::kMs})), ElementsAre(5 * 1e-3));
  EXPECT_THAT(errors(parsed("t,error_ms\n1,5\n", {.unit = ErrorUnit::kMs})), ElementsAre(5 * 1e-3));
}

TEST(ClockLog, TakesTheNamedColumnOfACsv) {
  const std::string text = "t,a_ms,b\n1,2,3\n2,4,6\n";
  EXPECT_THAT(errors(parsed(text, {.series = "b"})), ElementsAre(3, 6));
  EXPECT_THAT(errors(parsed(text, {.series = "a_ms"})), ElementsAre(2e-3, 4e-3));
  EXPECT_THAT(errors(parsed(text, {.series = "3"})), ElementsAre(3, 6));
  EXPECT_THAT(errors(parsed("1,2,3\n", {.series = "3"})), ElementsAre(3));
  EXPECT_THAT(problem(text), HasSubstr("log:1: found 3 columns, allowed: two (seconds, error)"));
  EXPECT_THAT(problem(text, {.series = "c"}), HasSubstr("--series: found 'c', allowed: the name"));
  EXPECT_THAT(problem(text, {.series = "1"}), HasSubstr("its number from 2 to 3"));
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
  EXPECT_THAT(ptp4l.notes,
              ElementsAre("log: 1 point before the servo locked (s0, s1) among those taken"));
  const ClockLog phc2sys = parsed(kPhc2sys);
  EXPECT_EQ(phc2sys.format, "phc2sys");
  EXPECT_THAT(errors(phc2sys), ElementsAre(1e-9 * 12, 1e-9 * -12));
  EXPECT_THAT(seconds(phc2sys), ElementsAre(101.001, 102.001));
  EXPECT_THAT(phc2sys.notes, ElementsAre("log: 1 line of other programs than phc2sys left out"));
}

TEST(ClockLog, TurnsTheSignOfNtpd) {
  const ClockLog log = parsed(kLoopstats);
  EXPECT_EQ(log.format, "loopstats");
  EXPECT_THAT(errors(log), ElementsAre(-0.000006019, 0.000006019));
  EXPECT_THAT(seconds(log), ElementsAre((50935 - 40587) * 86400.0 + 75440.031,
                                        (50935 - 40587) * 86400.0 + 75504.031));
}

TEST(ClockLog, SeveralSeriesNeedAName) {
  const std::string sources = std::string(kStatistics) +
                              "2016-08-10 05:41:55 PPS0 6.2e-03 7.000e-03  2.2e-03 1e-06 1e-06 "
                              "7.8e-02  16   0   8  0.00\n";
  EXPECT_THAT(problem(sources),
              AllOf(StartsWith("log:4: found a second series, 'PPS0', beside '203.0.113.15'"),
                    HasSubstr("--series")));
  EXPECT_THAT(errors(parsed(sources, {.series = "PPS0"})), ElementsAre(7e-3));
  EXPECT_THAT(problem(sources, {.series = "GPS"}),
              HasSubstr("of the series 'GPS', allowed: '203.0.113.15', 'PPS0'"));
  const std::string clocks =
      "phc2sys[1.0]: CLOCK_REALTIME phc offset 1 s2 freq +1\n"
      "phc2sys[1.1]: eth1 sys offset 2 s2 freq +1\n";
  EXPECT_THAT(problem(clocks), HasSubstr("log:2: found a second series, 'eth1 sys'"));
  EXPECT_THAT(errors(parsed(clocks, {.series = "eth1 sys"})), ElementsAre(1e-9 * 2));
}

TEST(ClockLog, RefusesOtherPrograms) {
  for (const char* text :
       {"hello world\n", "{\"a\": 1}\n",
        "\x7f"
        "ELF\x02\x01\x01\n",
        "0 1e-6\n", "0;0.5\n", "60000 75440.031 203.0.113.1 9614 -0.001605 0.00000 0.00142 0.1\n",
        "ts2phc[12.3]: eth0 master offset 12 s2 freq +1\n"}) {
    EXPECT_THAT(problem(text), AllOf(StartsWith("log:1: found "), HasSubstr("allowed: CSV")));
  }
  EXPECT_THAT(
      problem("   Date (UTC) Time  IP Address   L St 123 567 ABCD  LP RP Score    Offset\n"),
      AllOf(StartsWith("log:1: log of chrony: found "), HasSubstr("tracking.log or")));
  EXPECT_THAT(problem("2016-11-09 05:40:50 203.0.113.15 N 2 111 111 1111 10 10 1.0 -4.966e-03\n"),
              StartsWith("log:1: log of chrony: found "));
  EXPECT_THAT(problem("ptp4l[1.5]: rms  12 max  34 freq +1 +/- 2 delay 3 +/- 1\n"),
              AllOf(StartsWith("log:1: offset: found "), HasSubstr("summary_interval")));
  EXPECT_THAT(problem("phc2sys[1.5]: CLOCK_REALTIME rms  12 max  34 freq +1 +/- 2\n"),
              HasSubstr("-u (of phc2sys)"));
}

TEST(ClockLog, RefusesOtherUnits) {
  EXPECT_THAT(problem(kTracking, {.unit = ErrorUnit::kMs}),
              AllOf(HasSubstr("--unit: found a file of the format chrony_tracking"),
                    HasSubstr("allowed: with CSV files")));
  EXPECT_THAT(problem("t,error_us\n0,1\n", {.unit = ErrorUnit::kNs}),
              HasSubstr("log:1: --unit: found 'ns', allowed: us, which the column 'error_us'"));
  EXPECT_THAT(problem("t_ms,error\n0,1\n"),
              HasSubstr("log:1: time: found 't_ms', allowed: a first column of seconds"));
  EXPECT_THAT(problem("ptp4l[1.5]: master offset 12.5 s2 freq +1\n"),
              HasSubstr("offset: found '12.5', allowed: whole nanoseconds"));
}

TEST(ClockLog, RefusesWhatIsDamaged) {
  EXPECT_THAT(problem(""), HasSubstr("log:1: the file is empty"));
  EXPECT_THAT(problem("\n\n"), HasSubstr("log:2: the file ends without a time error"));
  EXPECT_THAT(problem("t,error\n"), HasSubstr("log:1: the file ends without a time error"));
  EXPECT_THAT(problem("0,1\n1,2,3\n"), HasSubstr("log:2: found 3 cells, allowed: 2"));
  EXPECT_THAT(problem("0,1\n1\n"), HasSubstr("log:2: found 1 cells, allowed: 2"));
  EXPECT_THAT(problem("0,1\nx,2\n"), HasSubstr("log:2: time: found 'x', allowed: a number of"));
  for (const char* number :
       {"nan", "inf", "-inf", "1e400", "2e9", "", "1x", "0x1p3", "++1", "+-1"}) {
    EXPECT_THAT(problem(std::string("0,1\n1,") + number + "\n"),
                HasSubstr("allowed: a number up to 1e+09"))
        << number;
  }
  EXPECT_THAT(problem("nan,1\n"), HasSubstr("time: found 'nan'"));
  EXPECT_THAT(problem("1e300,1\n"), HasSubstr("allowed: a number of seconds up to 4e11"));
  EXPECT_THAT(problem("0,1\n1,2\n0.5,3\n"), HasSubstr("log:3: found a time 0.5 s before"));
  EXPECT_THAT(problem("0,1\n0,2\n"), HasSubstr("log:2: found a time 0 s before"));
  const std::string tracking = kTracking;
  EXPECT_THAT(problem(tracking + "2017-08-22 13:24:00 203.0.113.15 2 -3.5\n"),
              HasSubstr("log:7: found 5 columns, allowed: at least 9"));
  EXPECT_THAT(problem(tracking + "2017-02-30 13:24:00 a 2 1 1 1 N 1\n"),
              HasSubstr("date: found '2017-02-30'"));
  EXPECT_THAT(problem(tracking + "2017-08-22 25:24:00 a 2 1 1 1 N 1\n"),
              HasSubstr("time: found '25:24:00'"));
  EXPECT_THAT(problem(tracking + kStatistics), HasSubstr("heading: found"));
  EXPECT_THAT(problem("50935 75440.031 0.1 1\n"), HasSubstr("found 4 columns, allowed: 5 to 7"));
  EXPECT_THAT(problem("50935 99999 0.1 1 1\n"), HasSubstr("second: found '99999'"));
  EXPECT_THAT(problem("ptp4l[12]: master offset 12 s2\n"), HasSubstr("time: found '[12]"));
}

TEST(ClockLog, NotesALastLineThatMayBeCut) {
  const ClockLog log = parsed("0,1\n1,2\n2,3");
  EXPECT_THAT(errors(log), ElementsAre(1, 2));
  EXPECT_THAT(log.notes, ElementsAre(StartsWith("log:3: the last line has no line end")));
  EXPECT_THAT(problem("0,1"), HasSubstr("ends without a time error"));
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
