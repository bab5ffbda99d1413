#include "recording/rs_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/read_fault.h"
#include "tests/scratch_folder.h"

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kHeader = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";

std::vector<RecordedStream> read(const std::string& text,
                                 const std::string& path = "dir/front.csv") {
  CsvRecordingReader reader;
  reader.read_text(text, path);
  return reader.take();
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const CsvError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RsCsv, AFileIsACameraOfItsName) {
  const auto streams = read(kHeader + "Depth,0,7,1000.001,12.5\nDepth,0,8,1033.334,45.75\n");
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_EQ(streams[0].camera, "front");
  EXPECT_EQ(streams[0].host, "front");
  EXPECT_EQ(streams[0].stream, "Depth 0");
  ASSERT_EQ(streams[0].frames.size(), 2U);
  EXPECT_EQ(streams[0].frames[1].counter, 8U);
  EXPECT_EQ(streams[0].frames[1].sensor, Nanoseconds(1'033'334'000));
  EXPECT_EQ(streams[0].frames[1].arrival, Nanoseconds(45'750'000));
}

TEST(RsCsv, ReadsWhatTheToolWrites) {
  const auto streams = read(
      "Configuration:\n"
      "Stream Type,Stream Name,Format,FPS,Width,Height\n"
      "Depth,Depth,Z16,30,848,480\n"
      "\n\nStream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n"
      "Depth,0,1,10.000,100.5\nDepth,0,2,43.000,133.5\n"
      "\n\nStream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),3DOF_x,3DOF_y,3DOF_z\n"
      "Gyro,0,1,10.1,100.9,0.1,0.2,0.3\n"
      "\n\nStream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n"
      "Infrared,1,1,10.000,101.5\n");
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].frames.size(), 2U);
  EXPECT_EQ(streams[1].stream, "Infrared 1");
  EXPECT_EQ(streams[1].camera, "front");
}

TEST(RsCsv, SeveralCamerasInOneFile) {
  const auto streams = read(
      "host,camera,Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),remark\n"
      "a,left,Depth,0,1,10,100,x\nb,right,Depth,0,1,20,101,\na,left,Depth,0,2,43,133,\n");
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].camera, "left");
  EXPECT_EQ(streams[0].host, "a");
  EXPECT_EQ(streams[0].frames.size(), 2U);
  EXPECT_EQ(streams[1].camera, "right");
}

TEST(RsCsv, StreamsHaveALimit) {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera\n";
  for (std::size_t camera = 0; camera < kMostRecordedStreams; ++camera) {
    text += "Depth,0,1,1,1,c" + std::to_string(camera) + "\n";
  }
  CsvRecordingReader reader;
  reader.read_text(text, "rig.csv");
  EXPECT_EQ(reader.take().size(), kMostRecordedStreams);
  EXPECT_THAT(refusal(text + "Depth,0,1,1,1,more\n"),
              HasSubstr(":4098: found more than 4096 streams of cameras"));
}

TEST(RsCsv, TheToolsFormWithoutACounterIsRead) {
  CsvRecordingReader reader;
  reader.read_text(
      "Stream Type,Index,HW Timestamp (ms),Host Timestamp(ms)\nDepth,0,1,2\nDepth,0,34,36\n",
      "front.csv");
  const std::vector<RecordedStream> streams = reader.take();
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_FALSE(streams[0].counted);
  EXPECT_EQ(streams[0].frames[1].counter, streams[0].frames[0].counter + 1);
}

TEST(RsCsv, ACameraGoesOnInTheNextFile) {
  CsvRecordingReader reader;
  const std::string header = "camera," + kHeader;
  reader.read_text(header + "left,Depth,0,1,10,100\n", "1.csv");
  reader.read_text(header + "left,Depth,0,2,43,133\n", "2.csv");
  const auto streams = reader.take();
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_EQ(streams[0].frames.size(), 2U);
  EXPECT_TRUE(reader.take().empty());
}

TEST(RsCsv, TakesLineEndsAndBlanksOfAllKinds) {
  const std::string text =
      "\xef\xbb\xbf"
      "stream type, Index ,f#,HW Timestamp(ms),Host Timestamp (ms)\r\n"
      "\r\n Depth , 0 , 1 , 10 , 100 \r\nDepth,0,2,43,133\n";
  const auto streams = read(text);
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_EQ(streams[0].frames.size(), 2U);
}

TEST(RsCsv, KeepsAWrappedRegisterAsItIs) {
  const auto streams = read(kHeader + "Depth,0,1,4294967.2,1\nDepth,0,2,0.033,2\n");
  EXPECT_EQ(streams[0].frames[1].sensor, Nanoseconds(33'000));
}

TEST(RsCsv, RefusesWhatIsNoRecording) {
  EXPECT_THAT(refusal(""), HasSubstr("front.csv:1: the file is empty"));
  EXPECT_THAT(refusal("value,other\n1,2\n"),
              HasSubstr(":1: found a table with the columns 'value', 'other', which is none of "
                        "rs-data-collect, allowed: --columns sensor="));
  EXPECT_THAT(refusal("Configuration:\nDepth,Depth,Z16\n"), HasSubstr(":2: the file ends"));
  EXPECT_THAT(refusal(kHeader), HasSubstr(":1: the file ends without a frame"));
  EXPECT_THAT(refusal(kHeader + "Gyro,0,1,10,100\n"), HasSubstr("without a frame"));
  EXPECT_THAT(refusal(std::string("\0\1\2\3", 4)), HasSubstr(":1: the file ends"));
}

TEST(RsCsv, NamesTheDamagedLine) {
  const std::string good = kHeader + "Depth,0,1,10,100\n";
  EXPECT_THAT(refusal(good + "Depth,0,2,43\n"), StartsWith("dir/front.csv:3: found 4 cells"));
  EXPECT_THAT(refusal(good + "Depth,0,2,4x,133\n"),
              HasSubstr(":3: HW Timestamp (ms): found '4x', allowed: a number"));
  EXPECT_THAT(refusal(good + "Depth,0,2,43,inf\n"), HasSubstr("Host Timestamp(ms): found 'inf'"));
  EXPECT_THAT(refusal(good + "Depth,0,two,43,133\n"), HasSubstr("counter: found 'two'"));
  EXPECT_THAT(refusal(good + ",0,2,43,133\n"), HasSubstr("empty cell"));
  EXPECT_THAT(refusal(good + "Stream Type,Index\n"), HasSubstr(":3: found 'Stream Type,Index'"));
  EXPECT_THAT(refusal(good + "Depth,0,1.5,43,133\n"), HasSubstr("allowed: a whole number"));
  EXPECT_THAT(refusal(good + "\"Depth,0,2,43,133\n"),
              HasSubstr(":3: found a quote without its end, allowed: a row on one line"));
  EXPECT_THAT(refusal(good + "Depth,0,2,43,\"133\n"), HasSubstr(":3: found a quote without"));
  const std::string endless(100'000, 'x');
  EXPECT_LT(refusal(good + "Depth,0,2," + endless + ",1\n").size(), 200U);
}

TEST(RsCsv, SkipsAQuoteWithoutItsEndBeforeTheHeader) {
  const std::string text = "Configuration:\n\"Depth\n" + kHeader + "Depth,0,1,10,100\n";
  EXPECT_EQ(read(text).front().frames.size(), 1U);
}

TEST(RsCsv, RefusesDecimalCommas) {
  EXPECT_THAT(refusal(kHeader + "Depth,0,1,10,5,100\n"),
              StartsWith("dir/front.csv:2: found 6 cells, allowed: 5, as in the header"));
  EXPECT_THAT(refusal("remark," + kHeader + "x,Depth,0,1,1000,000,12,345\n"),
              HasSubstr(":2: found 8 cells, allowed: 6"));
}

TEST(RsCsv, RefusesAColumnThatStandsTwice) {
  EXPECT_THAT(refusal("F#," + kHeader + "1,Depth,0,1,10,100\n"),
              HasSubstr(":1: found the column 'F#' twice"));
  EXPECT_EQ(read("remark,remark," + kHeader + ",,Depth,0,1,10,100\n").size(), 1U);
}

TEST(RsCsv, RefusesACameraOnTwoHosts) {
  EXPECT_THAT(refusal("host,camera," + kHeader + "a,0,Depth,0,1,10,100\nb,0,Depth,0,1,10,100\n"),
              HasSubstr(":3: camera '0': found host 'b', allowed: 'a' as before"));
}

// A prefix of a file has fewer frames, and none that the file does not have.
TEST(RsCsv, ACutFileHasNoOtherFrames) {
  const std::string text = kHeader + "Depth,0,7,1000.001,12.5\nDepth,0,8,1033.334,45.75\n" +
                           "Depth,0,9,1066.667,79.125\n";
  const auto whole = read(text)[0].frames;
  std::size_t accepted = 0;
  for (std::size_t size = 0; size < text.size(); ++size) {
    CsvRecordingReader reader;
    try {
      reader.read_text(text.substr(0, size), "cut.csv");
    } catch (const CsvError&) {
      continue;
    }
    ++accepted;
    EXPECT_EQ(reader.notes().size(), text[size - 1] == '\n' ? 0U : 1U) << size;
    const auto frames = reader.take()[0].frames;
    ASSERT_LT(frames.size(), whole.size()) << size;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].counter, whole[i].counter);
      EXPECT_EQ(frames[i].sensor, whole[i].sensor);
      EXPECT_EQ(frames[i].arrival, whole[i].arrival);
    }
  }
  EXPECT_GT(accepted, 40U);
}

TEST(RsCsv, ALastLineWithoutItsEndIsLeftOutWithANote) {
  CsvRecordingReader reader;
  reader.read_text(kHeader + "Depth,0,1,10,100\nDepth,0,2,43,13", "cut.csv");
  EXPECT_EQ(reader.take()[0].frames.size(), 1U);
  EXPECT_THAT(
      reader.notes(),
      ElementsAre("cut.csv:3: the last line has no line end and may be cut; it was left out"));
}

TEST(RsCsv, ColumnsOfAnyNameAndUnit) {
  CsvRecordingReader reader(
      RecordingColumns::parse("sensor=t cam:us,arrival=Host Time:s,counter=seq,camera=id"));
  reader.read_text(
      "id;seq;note;T cam;host time\nfront;7;a,b;1000.5;1790000000.123456789\n"
      "back;8;;2000;1790000000.2\n",
      "log.csv");
  const std::vector<RecordedStream> streams = reader.take();
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].camera, "front");
  EXPECT_EQ(streams[0].stream, "frame");
  EXPECT_TRUE(streams[0].counted);
  EXPECT_EQ(streams[0].frames[0].counter, 7U);
  EXPECT_EQ(streams[0].frames[0].sensor, Nanoseconds(1'000'500));
  EXPECT_EQ(streams[0].frames[0].arrival, Nanoseconds(1'790'000'000'123'456'789));
}

TEST(RsCsv, WithoutACounterFramesCountAsTheyCome) {
  CsvRecordingReader reader(RecordingColumns::parse("sensor=s:ns,arrival=a:ns"));
  reader.read_text("s\ta\n1\t10\n2\t20\n", "log.csv");
  const std::vector<RecordedStream> streams = reader.take();
  EXPECT_FALSE(streams[0].counted);
  EXPECT_EQ(streams[0].frames[1].counter, 1U);
  EXPECT_EQ(streams[0].frames[1].sensor, Nanoseconds(2));
}

TEST(RsCsv, ColumnsThatAreNotThereAreNamed) {
  const auto message_of = [](const std::string& columns, const std::string& text) -> std::string {
    try {
      CsvRecordingReader reader(RecordingColumns::parse(columns));
      reader.read_text(text, "log.csv");
    } catch (const CsvError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(
      message_of("sensor=s:us,arrival=b:us", "s,a\n1,2\n"),
      HasSubstr("log.csv:1: found no column 'b', allowed: 's', 'a', or a number from 1 to 2"));
  EXPECT_THAT(message_of("arrival=s", ""), HasSubstr("allowed: at least sensor=COLUMN"));
  EXPECT_THAT(message_of("sensor=s:parsec,arrival=a", ""), HasSubstr("units s, ms, us, ns, ps"));
  EXPECT_THAT(message_of("time=s,arrival=a", ""), HasSubstr("fields stream, index"));
  EXPECT_THAT(message_of("sensor=s,arrival=t,arrival=a", ""), HasSubstr("found 'arrival=a'"));
  EXPECT_THAT(message_of("sensor=s,sensor=t,camera=a", ""), HasSubstr("several sensor=COLUMN"));
  EXPECT_THAT(message_of("sensor=s:us,arrival=a:us", "s,a\n1,2\n1x,2\n"),
              HasSubstr("log.csv:3: s: found '1x'"));
  EXPECT_THAT(message_of("sensor=x,arrival=y", "x,y\n1,2\n1,2\n"),
              HasSubstr("found no unit of the stamps of column 'x', allowed: one behind its name"));
  // Without them, the message says how.
  CsvRecordingReader usual;
  try {
    usual.read_text("x,y\n1,2\n", "log.csv");
    ADD_FAILURE() << "accepted";
  } catch (const CsvError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--columns sensor=COLUMN:UNIT,arrival=COLUMN:UNIT"));
  }
}

// A table that is read with these columns ("": with none stated).
struct TableRead {
  std::vector<RecordedStream> streams{};
  std::vector<std::string> notes{};
};

TableRead table(const std::string& text, const std::string& columns = {}) {
  CsvRecordingReader reader =
      columns.empty() ? CsvRecordingReader() : CsvRecordingReader(RecordingColumns::parse(columns));
  reader.read_text(text, "t.csv");
  return {.streams = reader.take(), .notes = reader.notes()};
}

std::vector<std::int64_t> sensors_ns(const RecordedStream& stream) {
  std::vector<std::int64_t> found;
  for (const StampedFrame& frame : stream.frames) found.push_back(frame.sensor.count());
  return found;
}

TEST(RsCsv, ListsOfStampsAreReadAsTheyAre) {
  const TableRead euroc = table("1700000000123455872\n1700000000173456000\n");
  EXPECT_THAT(sensors_ns(euroc.streams.at(0)),
              ElementsAre(1700000000123455872, 1700000000173456000));
  EXPECT_EQ(euroc.streams[0].frames[1].arrival, euroc.streams[0].frames[1].sensor);
  EXPECT_THAT(euroc.notes, ElementsAre(HasSubstr("taken as ns since 1970, by its size"),
                                       HasSubstr("there is one clock only")));
  const TableRead tum = table(
      "# rgb maps\n# timestamp filename\n1700000100.003014 rgb/1.png\n"
      "1700000100.036890 rgb/2.png\n");
  EXPECT_THAT(sensors_ns(tum.streams.at(0)), ElementsAre(1700000100003014000, 1700000100036890000));
  const TableRead kitti = table("2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.064389445\n");
  EXPECT_THAT(sensors_ns(kitti.streams.at(0)),
              ElementsAre(1317042145964389445, 1317042146064389445));
  const TableRead mav0 = table(
      "#timestamp [ns],filename\n1403636579763555584,1.png\n"
      "1403636579813555456,2.png\n");
  EXPECT_THAT(sensors_ns(mav0.streams.at(0)),
              ElementsAre(1403636579763555584, 1403636579813555456));
  EXPECT_THAT(sensors_ns(table("seq,time_ms\n7,0.5\n8,33.8\n").streams.at(0)),
              ElementsAre(500'000, 33'800'000));
  EXPECT_EQ(table("seq,time_ms\n7,0.5\n8,33.8\n").streams[0].frames[1].counter, 8U);
}

TEST(RsCsv, UnitsOfStampsAreStatedOrSaid) {
  const TableRead headed =
      table("cam_us,host_s\n1000,0.5\n2000,1.5\n", "sensor=cam_us,arrival=host_s");
  EXPECT_THAT(sensors_ns(headed.streams.at(0)), ElementsAre(1'000'000, 2'000'000));
  EXPECT_EQ(headed.streams[0].frames[0].arrival, Nanoseconds(500'000'000));
  EXPECT_THAT(headed.notes, ElementsAre());
  const TableRead rated = table("c,h\n0,1.5\n33333,34.8\n66667,68.1\n", "sensor=c,arrival=h");
  EXPECT_THAT(sensors_ns(rated.streams.at(0)), ElementsAre(0, 33'333'000, 66'667'000));
  EXPECT_THAT(rated.notes, ElementsAre(HasSubstr("column 'c': taken as us, by its rate"),
                                       HasSubstr("column 'h': taken as ms, by its rate")));
  const TableRead ticks = table("t,h\n0,0\n4166666,33\n", "sensor=t:8ns,arrival=h:ms");
  EXPECT_THAT(sensors_ns(ticks.streams.at(0)), ElementsAre(0, 33'333'328));
  const TableRead numbered = table("0;1,5\n33,3;2,5\n", "sensor=1:ms,arrival=2:s");
  EXPECT_THAT(sensors_ns(numbered.streams.at(0)), ElementsAre(0, 33'300'000));
}

TEST(RsCsv, ReadsWhatNumpyWrites) {
  const TableRead saved = table(
      "# frame,cam_s,host_s\n0.000000000000000000e+00,0.000000000000000000e+00,"
      "1.700000000014576435e+09\n1.000000000000000000e+00,3.333333333333333287e-02,"
      "1.700000000048232317e+09\nnan,nan,nan\n",
      "sensor=cam_s,arrival=host_s,counter=frame");
  EXPECT_THAT(sensors_ns(saved.streams.at(0)), ElementsAre(0, 33'333'333));
  EXPECT_EQ(saved.streams[0].frames[1].counter, 1U);
  EXPECT_THAT(saved.notes,
              ElementsAre("t.csv: 1 cell without a stamp left out, the first in line 4"));
  const TableRead quoted = table("\"frame\",\"cam_ts\"\n\"0\",\"-0.5\"\n\"1\",\"0.5\"\n",
                                 "sensor=cam_ts:s,arrival=cam_ts:s,counter=frame");
  EXPECT_THAT(sensors_ns(quoted.streams.at(0)), ElementsAre(-500'000'000, 500'000'000));
}

TEST(RsCsv, ARowMayBeASetOfFrames) {
  const TableRead sets = table("left_ms,right_ms,host_ms\n0,1,5\n33,,38\n66,67,71\n",
                               "sensor=left_ms,sensor=right_ms,arrival=host_ms");
  ASSERT_EQ(sets.streams.size(), 2U);
  EXPECT_EQ(sets.streams[0].camera, "left_ms");
  EXPECT_THAT(sensors_ns(sets.streams[0]), ElementsAre(0, 33'000'000, 66'000'000));
  EXPECT_THAT(sensors_ns(sets.streams[1]), ElementsAre(1'000'000, 67'000'000));
  EXPECT_EQ(sets.streams[1].host, sets.streams[0].host);
}

TEST(RsCsv, FilesAreNamedByWhatTellsThemApart) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(camera_names({"a/front/cam.csv", "a/back/cam.csv", "top.csv"}),
            (Names{"front/cam", "back/cam", "top"}));
  EXPECT_EQ(camera_names({"cam.csv", "rig/cam.csv", "./b/rig/cam.csv"}),
            (Names{"cam", "rig/cam", "b/rig/cam"}));
  EXPECT_EQ(camera_names({"cam.csv", "cam.txt"}), (Names{"cam.csv", "cam.txt"}));
  EXPECT_EQ(camera_names({"x/a.csv", "y/b.csv"}), (Names{"a", "b"}));
}

TEST(RsCsv, RecordingsOfOneNameAreTwoCameras) {
  const ScratchFolder folder;
  const std::string front = folder.write("front/cam.csv", kHeader + "Depth,0,1,10,100\n");
  const std::string back = folder.write("back/cam.csv", kHeader + "Depth,0,1,20,101\n");
  const auto streams = read_recordings({front, back}).streams;
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].camera, "front/cam");
  EXPECT_EQ(streams[0].host, "front/cam");
  EXPECT_EQ(streams[1].camera, "back/cam");
  // A column may not name the camera that another file is.
  const std::string rig = folder.write("rig.csv", "camera," + kHeader + "cam,Depth,0,2,43,133\n");
  try {
    read_recordings({front, rig});
    ADD_FAILURE() << "accepted";
  } catch (const CsvError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rig.csv:2: camera 'cam' is in "));
  }
  EXPECT_THROW(read_recordings({front, folder / "back/../front/cam.csv"}), CsvError);
}

TEST(RsCsv, NamesAreShownAndNotObeyed) {
  const auto streams =
      read("camera,host," + kHeader +
           "\x1b[2Jred,h\x7f,Depth,0,1,10,100\n\xc3\xa4\xc2\x9b,h\xff,Depth,0,1,10,1\n");
  EXPECT_EQ(streams[0].camera, "\\x1b[2Jred");
  EXPECT_EQ(streams[0].host, "h\\x7f");
  EXPECT_EQ(streams[1].camera, "\xc3\xa4\\xc2\\x9b");
  EXPECT_EQ(streams[1].host, "h\\xff");
}

TEST(RsCsv, AReadErrorAtAnyByteIsAnError) {
  const ScratchFolder folder;
  const std::string text = kHeader + "Depth,0,1,10,100\nDepth,0,2,43,133\n";
  const std::string path = folder.write("cam.csv", text);
  for (std::size_t byte = 0; byte <= text.size(); ++byte) {
    const ReadFault fault(byte);
    EXPECT_THROW(read_recordings({path}), CsvError) << byte;
  }
}

TEST(RsCsv, RefusesFilesThatCannotBeRead) {
  CsvRecordingReader reader;
  EXPECT_THROW(reader.read_file("/no/such/file.csv"), CsvError);
  EXPECT_THROW(reader.read_file("/"), CsvError);
  EXPECT_THROW(reader.read_file("/dev/zero"), CsvError);
  EXPECT_THROW(reader.read_file("/proc/self/mem"), CsvError);
}

}  // namespace
}  // namespace simbench
