#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "reports/timeline/trace.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string csv(const Trace& trace) {
  std::ostringstream out;
  write_trace_csv(trace, out);
  return out.str();
}

TEST(TraceCsv, EverySeriesHasItsCellsAndTimeGoesUp) {
  Trace trace;
  trace.hosts = 2;
  trace.cameras = {{0}, {1}};
  trace.pulses = {{.pulse = 7, .at = TrueTime(from_ms(1))}};
  trace.clocks = {{TrueTime(from_ms(1)), 0, Nanoseconds(0)},
                  {TrueTime(from_ms(1)), 1, Nanoseconds(-2500)}};
  TraceFrame frame;
  frame.way = {.camera = 1,
               .host = 1,
               .pulse = 7,
               .exposure_start = TrueTime(from_ms(1)),
               .exposure_end = TrueTime(from_ms(3)),
               .delivered = TrueTime(from_ms(12))};
  frame.stamp = GlobalTime(from_ms(2.5));
  frame.reference = HostTime(from_ms(2));
  trace.frames = {frame};
  trace.sets = {{.frames = {0},
                 .members = 1,
                 .complete = false,
                 .range = Nanoseconds(0),
                 .begin = TrueTime(from_ms(12)),
                 .end = TrueTime(from_ms(12.5))}};
  EXPECT_EQ(csv(trace),
            "time_s,trigger/pulse,host1/clock_error_us,camera1/latency_ms,camera1/stamp_error_us,"
            "gathering/stamps_range_us,gathering/frames\n"
            "0.001000000,7.000,-2.500,,,,\n"
            "0.012000000,,,10.000,500.000,,\n"
            "0.012500000,,,,,0.000,1.000\n");
}

TEST(TraceCsv, SetsHaveTheirCertificates) {
  Trace trace;
  trace.sets = {{.frames = {},
                 .members = 2,
                 .complete = true,
                 .range = Nanoseconds(0),
                 .certified_ms = 0.75,
                 .begin = TrueTime(from_ms(12)),
                 .end = TrueTime(from_ms(12.5))}};
  EXPECT_EQ(csv(trace),
            "time_s,gathering/stamps_range_us,gathering/frames,gathering/certified_ms\n"
            "0.012500000,0.000,2.000,0.750\n");
}

TEST(TraceCsv, StreamsHaveColumnsOfTheirOwnAndOfTwoValuesTheLaterIsShown) {
  Trace trace;
  trace.cameras = {{0}};
  for (const double exposed_ms : {1, 2}) {
    TraceFrame frame;
    frame.way.stream = StreamKind::kColour;
    frame.way.exposure_start = frame.way.exposure_end = TrueTime(from_ms(exposed_ms));
    frame.way.delivered = TrueTime(from_ms(5));
    trace.frames.push_back(frame);
  }
  EXPECT_EQ(csv(trace), "time_s,camera0/colour/latency_ms\n0.005000000,3.000\n");
}

TEST(TraceCsv, ColumnsAreBounded) {
  Trace trace;
  trace.hosts = kTraceCsvPlaces + 1;
  trace.clocks = {{TrueTime{}, kTraceCsvPlaces - 1, Nanoseconds(1)},
                  {TrueTime{}, kTraceCsvPlaces, Nanoseconds(1)}};
  EXPECT_EQ(csv(trace), "time_s,host99/clock_error_us\n0.000000000,0.001\n");
  EXPECT_THAT(trace_csv_notes(trace), testing::ElementsAre(HasSubstr("101 hosts")));
  trace.hosts = kTraceCsvPlaces;
  EXPECT_THAT(trace_csv_notes(trace), IsEmpty());
}

}  // namespace
}  // namespace simbench::reports
