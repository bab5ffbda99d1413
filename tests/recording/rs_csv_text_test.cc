#include "recording/rs_csv_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "recording/rs_csv.h"

namespace simbench {
namespace {

RecordedStream stream_of(const std::string& camera, const std::string& host, int frames) {
  RecordedStream stream;
  stream.camera = camera;
  stream.host = host;
  stream.stream = "Depth 0";
  for (int i = 0; i < frames; ++i) {
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(10 + 2 * i),
                             .sensor = Nanoseconds(1'000'000'001 + i * 33'333'333LL),
                             .arrival = Nanoseconds(1'700'000'000'000'000'017 + i * 33'333'000LL)});
  }
  return stream;
}

std::vector<RecordedStream> read_again(const std::string& text) {
  CsvRecordingReader reader;
  reader.read_text(text, "rig.csv");
  return reader.take();
}

TEST(RsCsvText, IsReadAgainAsItWas) {
  std::vector<RecordedStream> streams = {stream_of("front", "left", 5),
                                         stream_of("back", "right", 3)};
  streams[0].set(streams[0].columns.exposure_us, 8000);
  streams[0].complete_columns();
  const std::vector<RecordedStream> again = read_again(rs_csv_text(streams));
  ASSERT_EQ(again.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again[i].camera, streams[i].camera);
    EXPECT_EQ(again[i].host, streams[i].host);
    EXPECT_EQ(again[i].stream, "Depth 0");
    EXPECT_TRUE(again[i].counted);
    ASSERT_EQ(again[i].frames.size(), streams[i].frames.size());
    for (std::size_t k = 0; k < again[i].frames.size(); ++k) {
      EXPECT_EQ(again[i].frames[k].counter, streams[i].frames[k].counter);
      EXPECT_EQ(again[i].frames[k].sensor, streams[i].frames[k].sensor);
      EXPECT_EQ(again[i].frames[k].arrival, streams[i].frames[k].arrival);
    }
  }
  EXPECT_EQ(again[0].columns.exposure_us.back(), 8000);
  EXPECT_TRUE(std::isnan(again[0].columns.exposure_us.front()));
}

// A camera that did not count loses no frame by its counter, so none is written.
TEST(RsCsvText, WithoutCountersThereIsNoColumn) {
  std::vector<RecordedStream> streams = {stream_of("front", "left", 3)};
  streams[0].counted = false;
  const std::string text = rs_csv_text(streams);
  EXPECT_EQ(text.find("F#"), std::string::npos);
  const std::vector<RecordedStream> again = read_again(text);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_FALSE(again[0].counted);
}

TEST(RsCsvText, ANamelessStreamHasNoNames) {
  const RecordedStream stream = stream_of("", "", 1);
  EXPECT_EQ(rs_csv_text({&stream, 1}),
            "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n"
            "Depth,0,10,1000.000001,1700000000000.000017\n");
}

TEST(RsCsvText, NamesWithCommasAndQuotesAreReadAgain) {
  const std::vector<RecordedStream> streams = {stream_of("left, upper", "the \"old\" one", 2)};
  const std::vector<RecordedStream> again = read_again(rs_csv_text(streams));
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].camera, "left, upper");
  EXPECT_EQ(again[0].host, "the \"old\" one");
  EXPECT_EQ(again[0].frames.size(), 2U);
}

}  // namespace
}  // namespace simbench
