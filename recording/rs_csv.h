// Recordings of real cameras as text: the CSV that librealsense's rs-data-collect writes.
//
//   Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)
//   Depth,0,1,1000.000,12.345
//
// HW Timestamp is the frame stamp on the camera's clock, Host Timestamp the arrival in milliseconds
// since the tool was started. The tool's own files are read as they are: the "Configuration:" part
// before the header is skipped, a header may come again for each stream, columns may stand in any
// order, and unknown ones are ignored. Without F# frames count as they come. Gyro, Accel and Pose
// lines are no frames and are skipped.
//
// Two more columns allow several cameras in one file: `camera` and `host` (names or numbers).
// Without `camera`, a file is one camera with the name of the file, and of the folders that tell it
// from the other files ("front/cam", "back/cam"); without `host`, the host has that name. A camera
// that files name in a column continues in the order of the files. Stamps of several cameras must
// count from one zero per host, and, for a meaningful spread, from one for all hosts.
//
// Tables of any other tool (recording/table.h) are read by RecordingColumns, or, where nothing is
// said, by what they show (recording/recording_columns.h): one row a frame, or one a set of frames
// with a column of stamps for each camera. Without a column for the counter frames count as they
// come; without one for the stream, it is "frame"; without one for the arrival, the stamps stand
// for it. Rows without a stamp (empty, NaN) are left out and counted.
//
// What may be wrong is refused, with its line: more or fewer cells than the header has, a column
// that stands twice, a camera on two hosts, more streams than any rig has. A last line without its
// line end may be cut in mid-number: it is left out, with a note. Names have control characters as
// \xHH.
//
// Stamps are kept to the nanosecond, as written: a wrapped register is not unwrapped here.
// Complexity: linear in the text; memory: that of the frames. Source: docs/reference/d455.md
// section 8.
//
//   CsvRecordingReader reader;
//   reader.read_file("front.csv");
//   reader.read_file("back.csv");
//   std::vector<RecordedStream> streams = reader.take();
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "recording/recorded_streams.h"
#include "recording/recording_columns.h"

namespace simbench {

// Largest stamp, in milliseconds either way: 126 years.
inline constexpr std::int64_t kLargestStampMs = 4'000'000'000'000;

class CsvRecordingReader {
 public:
  // Reads what rs-data-collect writes, and other tables as they show.
  CsvRecordingReader() = default;
  explicit CsvRecordingReader(RecordingColumns columns) : columns_(std::move(columns)) {}

  // `name`: of the camera, if the file names none; empty: that of the file. Throws CsvError:
  // unreadable, without a header or a frame, a line that is damaged.
  void read_file(const std::string& path, const std::string& name = {},
                 const ReadProgress& progress = {});
  // Reads text as if it were the content of `path`.
  void read_text(std::string_view text, const std::string& path);

  // In order of first occurrence. The reader is empty afterwards.
  std::vector<RecordedStream> take();
  // What was left out, a line each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  class File;

  // Who named a camera.
  struct Naming {
    std::string path;        // of the file that did so first
    bool by_column = false;  // else the file is the camera
    bool with_host = false;  // a column names its host
    std::string host{};
  };
  struct Known {
    std::size_t stream;
    const Naming* camera;
  };

  std::optional<RecordingColumns> columns_;
  std::vector<RecordedStream> streams_;
  std::unordered_map<std::string, Known> index_;  // by camera and stream
  std::unordered_map<std::string, Naming> cameras_;
  std::vector<std::string> notes_;
};

// The streams of all files, in order. Throws CsvError, also for a file that is given twice.
RecordedStreams read_recordings(const std::vector<std::string>& files,
                                const ReadProgress& progress = {});
// Throws CsvError.
void check_given_once(const std::vector<std::string>& files);

// The name of each file as a camera: its last parts, without the extension, as few as tell it from
// all others.
std::vector<std::string> camera_names(const std::vector<std::string>& files);

}  // namespace simbench
