#include "app/ibl_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "app/stream_run.h"
#include "evaluation/frames/camera_statistics.h"
#include "evaluation/frames/frame_account.h"
#include "recording/rs_csv.h"
#include "recording/rs_csv_text.h"
#include "tests/data/ibl_recordings.h"
#include "tests/read_fault.h"
#include "tests/scratch_folder.h"

namespace simbench::app {
namespace {

using testing::HasSubstr;

std::uint32_t cycle_clock(unsigned seconds, unsigned cycles, unsigned offsets) {
  return seconds << 25 | cycles << 12 | offsets;
}

std::string row(double ticks, double reading, double counter) {
  const std::array<double, 4> cells = {ticks, reading, counter, 0};
  std::string bytes(sizeof cells, '\0');
  std::memcpy(bytes.data(), cells.data(), sizeof cells);
  return bytes;
}

TEST(IblRecording, TextIsDecodedAndItsClockGoesOn) {
  const std::string text =
      "2020-08-19T23:59:59.9000000-04:00 " + std::to_string(cycle_clock(127, 7999, 3071)) +
      " \n2020-08-20T00:00:00.1234567-04:00 " + std::to_string(cycle_clock(0, 4000, 1536)) + "\n";
  const ScratchFolder folder;
  const auto frames = read_ibl_recording(folder.write("x.ssv", text));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].arrival, Nanoseconds(0));
  EXPECT_EQ(frames[1].arrival, Nanoseconds(223'456'700));
  EXPECT_NEAR(to_ms(frames[0].sensor), 128'000 - 1e3 / 8000 / 3072, 1e-6);
  EXPECT_NEAR(to_ms(frames[1].sensor), 128'500.0625, 1e-6);
  EXPECT_EQ(frames[1].counter, 1U);
}

TEST(IblRecording, FrameDataIsDecoded) {
  const auto frames =
      parse_ibl_frame_data(row(637568488067305600.0, cycle_clock(81, 0, 0), 40) +
                               row(637568488067635712.0, cycle_clock(81, 264, 0), 41),
                           "x.bin");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].counter, 40U);
  EXPECT_EQ(frames[1].arrival, Nanoseconds(33'011'200));
  EXPECT_EQ(frames[1].sensor - frames[0].sensor, Nanoseconds(33'000'000));
}

// Part of the variance of this camera's delays is slow (docs/reference/d455.md section 4): the
// nominal worlds take that part, as AR(1), for common to a host's cameras.
TEST(IblRecording, PartOfTheRealDelaysIsSlow) {
  SIMBENCH_SKIP_WITHOUT(kRealBody);
  std::vector<double> delays_ms;
  for (const StampedFrame& frame : read_ibl_recording(kRealBody)) {
    delays_ms.push_back(to_ms(frame.arrival - frame.sensor));
  }
  // Less the clocks' drift: the mean of the 30 s around each.
  constexpr std::size_t kReach = 450;
  std::vector<double> residuals_ms;
  for (std::size_t i = kReach; i + kReach < delays_ms.size(); ++i) {
    const auto first = delays_ms.begin() + static_cast<std::ptrdiff_t>(i - kReach);
    const double sum = std::accumulate(first, first + 2 * kReach + 1, 0.0);
    residuals_ms.push_back(delays_ms[i] - sum / (2 * kReach + 1));
  }
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = lag; i < residuals_ms.size(); ++i) {
      sum += residuals_ms[i] * residuals_ms[i - lag];
    }
    return sum / static_cast<double>(residuals_ms.size() - lag);
  };
  EXPECT_NEAR(std::sqrt(covariance(0)), 0.18, 0.005);
  EXPECT_NEAR(covariance(1) / covariance(0), 0.10, 0.01);
  EXPECT_NEAR(covariance(2) / covariance(0), 0.11, 0.01);
  double later = 0;
  for (std::size_t lag = 3; lag <= 10; ++lag) later += covariance(lag) / covariance(0) / 8;
  EXPECT_NEAR(later, 0.018, 0.005);
}

TEST(IblRecording, DamagedFilesAreRefused) {
  const ScratchFolder folder;
  const std::string good = "2020-08-19T12:42:57.7903616-04:00 2330554981 \n";
  for (const char* line :
       {"hello", "2020-08-19T12:42:57.7903616-04:00", "2020-13-19T12:42:57.7903616-04:00 1",
        "2020-08-19T12:42:57.7903616-04:00 99999999999", "2020-08-19T12:42:57.7903616-04:00 4095",
        "2020-08-19T12:42:57 2330554981"}) {
    try {
      read_ibl_recording(folder.write("x.ssv", good + line + "\n"));
      ADD_FAILURE() << "accepted: " << line;
    } catch (const CsvError& error) {
      EXPECT_THAT(error.what(), HasSubstr("x.ssv:2: allowed: a time")) << line;
    }
  }
  EXPECT_THROW(read_ibl_recording(folder.write("x.ssv", "")), CsvError);
  // The clock may be cut in mid-number.
  EXPECT_THROW(read_ibl_recording(folder.write("x.ssv", good + good.substr(0, 40))), CsvError);
  EXPECT_THROW(parse_ibl_frame_data("", "x.bin"), CsvError);
  EXPECT_THROW(parse_ibl_frame_data("short", "x.bin"), CsvError);
  EXPECT_THROW(parse_ibl_frame_data(row(1, 4096, -1), "x.bin"), CsvError);
  EXPECT_THROW(parse_ibl_frame_data(row(1, 4095, 1), "x.bin"), CsvError);
  EXPECT_THROW(parse_ibl_frame_data(row(0.5, 4096, 1), "x.bin"), CsvError);
  EXPECT_THROW(parse_ibl_frame_data(row(1, 4096, 1) + row(0x1p62, 4096, 1), "x.bin"), CsvError);
  EXPECT_THROW(read_ibl_recording("frames.txt"), CsvError);
  EXPECT_THROW(read_ibl_recording("/no/such.bin"), CsvError);
}

TEST(IblRecording, AReadErrorAtAnyByteIsAnError) {
  const ScratchFolder folder;
  const std::string text = "2020-08-19T12:42:57.7903616-04:00 2330554981 \n";
  const std::string lines = folder.write("x.ssv", text + text);
  const std::string rows = folder.write("x.bin", row(1, 4096, 1) + row(2, 8192, 2));
  for (const std::string& path : {lines, rows}) {
    const std::size_t size = content(path).size();
    EXPECT_EQ(read_ibl_recording(path).size(), 2U);
    for (std::size_t byte = 0; byte <= size; ++byte) {
      const ReadFault fault(byte);
      EXPECT_THROW(read_ibl_recording(path), CsvError) << path << " " << byte;
    }
  }
}

// Numbers of frames that the generated recordings lack: one, two together, one.
const std::vector<std::int64_t> kLost = {700, 3000, 3001, 5000};

TEST(IblRecording, EveryStampOfAGeneratedRecordingIsRead) {
  const ScratchFolder folder;
  const IblWorld world = {.lost = kLost};
  const std::vector<IblFrame> made = ibl_frames(world);
  for (const std::string& path : {folder.write("a.timestamps.ssv", ibl_timestamps(world)),
                                  folder.write("a.frameData.bin", ibl_frame_data(world))}) {
    const auto frames = read_ibl_recording(path);
    ASSERT_EQ(frames.size(), made.size());
    const bool counts = path.ends_with(".bin");
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::int64_t number = made[i].number;
      // 33.125 ms are whole microseconds, and the clock goes on where it wraps.
      ASSERT_EQ(frames[i].sensor, Nanoseconds(108'000'000'000 + number * 33'125'000)) << i;
      ASSERT_EQ(frames[i].arrival, Nanoseconds(100 * (made[i].host_100_ns - made[0].host_100_ns)));
      ASSERT_EQ(frames[i].counter, counts ? 1000U + static_cast<unsigned>(number) : i);
    }
    const evaluation::CameraStatistics found = evaluation::camera_statistics(frames);
    EXPECT_EQ(found.long_intervals, 3);
    EXPECT_EQ(evaluation::frame_account(frames, counts).lost, counts ? 4 : 0);
  }
}

std::vector<RecordedStream> through_csv(const std::string& path) {
  CsvRecordingReader reader;
  const RecordedStream stream = ibl_stream(read_ibl_recording(path));
  reader.read_text(rs_csv_text({&stream, 1}), "body.csv");
  return reader.take();
}

// Exponential delays of mean m: excess m, median m ln 2, quantile q of -m ln(1 - q), deviation m.
// The tolerances are four standard errors of 6001 frames; the drift's is 0.2 ms / (57.4 s
// sqrt(6001)).
TEST(IblRecording, AGeneratedRecordingGivesWhatWasPutIn) {
  const ScratchFolder folder;
  const std::vector<RecordedStream> streams = through_csv(folder.write("a.ssv", ibl_timestamps()));
  ASSERT_EQ(streams.size(), 1U);
  const evaluation::CameraStatistics found =
      evaluation::camera_statistics(evaluation::unwrapped(streams[0].frames));
  EXPECT_EQ(found.frames, 6001);
  EXPECT_EQ(found.long_intervals, 0);
  EXPECT_NEAR(found.span_s, 6 * 33.125 * (1 - 215e-6), 0.004);  // of arrivals
  EXPECT_NEAR(found.sensor_period.mean_ms, 33.125, 1e-9);
  EXPECT_NEAR(found.sensor_period.sd_ms, 0, 1e-9);
  EXPECT_NEAR(found.arrival_period.mean_ms, 33.125 * (1 - 215e-6), 0.001);
  EXPECT_NEAR(found.arrival_period.sd_ms, 0.2 * std::sqrt(2), 0.02);
  EXPECT_NEAR(found.drift_ppm, -215, 0.18);
  EXPECT_NEAR(found.envelope_drift_ppm, -215, 0.01);  // two minima, 159 s apart
  EXPECT_NEAR(found.residual.sd_ms, 0.2, 0.015);
  EXPECT_NEAR(found.excess.mean_ms, 0.2, 0.011);
  EXPECT_NEAR(found.excess.p50_ms, 0.2 * std::log(2), 0.011);
  EXPECT_NEAR(found.excess.p95_ms, 0.2 * std::log(20), 0.046);
  EXPECT_NEAR(found.excess.p99_ms, 0.2 * std::log(100), 0.11);
}

TEST(IblRecording, TheRealBodyCameraGivesItsCheckValues) {
  SIMBENCH_SKIP_WITHOUT(kRealBody);
  const std::vector<RecordedStream> streams = through_csv(kRealBody);
  ASSERT_EQ(streams.size(), 1U);
  const evaluation::CameraStatistics found =
      evaluation::camera_statistics(evaluation::unwrapped(streams[0].frames));
  EXPECT_EQ(found.frames, 6001);
  EXPECT_EQ(found.long_intervals, 0);
  EXPECT_NEAR(found.span_s, 198.6, 0.05);
  EXPECT_NEAR(found.sensor_period.mean_ms, 33.1007, 0.00005);
  EXPECT_NEAR(found.sensor_period.sd_ms, 0.00126, 0.000005);
  EXPECT_NEAR(found.arrival_period.mean_ms, 33.0935, 0.00005);
  EXPECT_NEAR(found.arrival_period.sd_ms, 0.2455, 0.00005);
  EXPECT_NEAR(found.drift_ppm, -215.385, 0.0005);
  EXPECT_NEAR(found.envelope_drift_ppm, -214.932, 0.0005);
  EXPECT_NEAR(found.residual.sd_ms, 0.1878, 0.00005);
  EXPECT_NEAR(found.residual.p99_ms, 0.636, 0.0005);
  EXPECT_NEAR(found.residual.max_ms, 3.069, 0.0005);
  EXPECT_NEAR(found.excess.mean_ms, 0.217, 0.0005);
  EXPECT_NEAR(found.excess.p50_ms, 0.160, 0.0005);
  EXPECT_NEAR(found.excess.p95_ms, 0.600, 0.0005);
  EXPECT_NEAR(found.excess.p99_ms, 0.872, 0.0005);
  EXPECT_NEAR(found.excess.max_ms, 3.327, 0.0005);
  const auto stamped = stamped_streams(streams, {"regression_offline"}, "--stamps");
  ASSERT_EQ(stamped.size(), 1U);
  const evaluation::StampStatistics regression = evaluation::stamp_statistics(stamped[0]);
  EXPECT_NEAR(regression.drift_ppm, -215.385, 0.005);
  EXPECT_NEAR(regression.residual.sd_ms, 0.1878, 0.0005);
}

TEST(IblRecording, TheRealLeftCameraIsRead) {
  SIMBENCH_SKIP_WITHOUT(kRealLeft);
  const auto frames = read_ibl_recording(kRealLeft);
  ASSERT_EQ(frames.size(), 135U);
  EXPECT_EQ(frames.front().counter, 389918212U);
  EXPECT_EQ(frames.back().counter, 389918346U);
  const evaluation::CameraStatistics found = evaluation::camera_statistics(frames);
  EXPECT_EQ(evaluation::frame_account(frames, /*counted=*/true).lost, 0);
  EXPECT_NEAR(found.sensor_period.mean_ms, 33.341, 0.0005);
  EXPECT_NEAR(found.sensor_period.sd_ms, 0.00229, 0.000005);
  EXPECT_NEAR(found.arrival_period.mean_ms, 33.3319, 0.00005);
  EXPECT_NEAR(found.arrival_period.sd_ms, 0.5055, 0.00005);
  EXPECT_NEAR(found.drift_ppm, 59.313, 0.0005);
  EXPECT_NEAR(found.envelope_drift_ppm, 117.742, 0.0005);
  EXPECT_NEAR(found.residual.sd_ms, 0.3643, 0.00005);
}

}  // namespace
}  // namespace simbench::app
