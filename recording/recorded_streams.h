// Streams of stamped frames: what is known of a rig from its files alone, without a truth and
// without the events of its hosts.
//
//   for (const RecordedStream& stream : app::recorded_streams({"rig.bag"}).streams) ...
//
// Stamps are kept to the nanosecond, as written: a wrapped register is not unwrapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench {

struct StampedFrame {
  std::uint64_t counter = 0;
  Nanoseconds sensor{};   // of the camera's clock
  Nanoseconds arrival{};  // since the zero of its host
};

// Where the frames of a stream are, for who wants to take them out of their file.
struct StreamOrigin {
  std::string file{};
  std::string topic{};                    // of a bag
  std::string stamps{};                   // what `sensor` is: "SENSOR_TIMESTAMP (camera's clock)"
  std::string arrivals{};                 // likewise: "log time (recorder's clock)"
  std::vector<std::uint64_t> messages{};  // a number a frame, of the topic's messages
};

// What a recording says of each frame beside its stamps: a column is empty, or has a value a frame,
// NaN where it is unknown.
struct FrameColumns {
  std::vector<double> exposure_us{};
  std::vector<double> backend_ms{};  // when the host's driver had it, before its arrival: negative
  std::vector<double> bytes{};       // of the image as it was sent
  std::vector<double> temperature_c{};

  // f(column) for each.
  template <class Column>
  void for_each(const Column& f) {
    for (auto* column : {&exposure_us, &backend_ms, &bytes, &temperature_c}) f(*column);
  }
};

// One stream of one camera, frames in order of delivery.
struct RecordedStream {
  std::string camera;
  std::string host;
  std::string stream;  // "Depth 0": type and index
  std::vector<StampedFrame> frames;
  // The camera counted its frames; else the counter is their order of delivery, and a gap in time
  // does not tell whether a frame was lost or never exposed.
  bool counted = true;
  // A computer stamped the frames (a message's header), not the camera.
  bool stamped_by_host = false;
  // librealsense recorded it: its words and options apply.
  bool realsense = false;
  StreamOrigin origin{};
  FrameColumns columns{};

  // Sets a column's value of the last frame; earlier frames without one are NaN.
  void set(std::vector<double>& column, double value) const {
    column.resize(frames.size(), std::numeric_limits<double>::quiet_NaN());
    column.back() = value;
  }
  // After the last frame.
  void complete_columns() {
    columns.for_each([this](std::vector<double>& column) {
      if (!column.empty()) column.resize(frames.size(), std::numeric_limits<double>::quiet_NaN());
    });
  }
};

// No rig has more; a file that names more is refused, or read up to there with a note.
inline constexpr std::size_t kMostRecordedStreams = 4096;

struct RecordedStreams {
  std::vector<RecordedStream> streams;
  std::vector<std::string> notes;  // for the user: what was left out
};

// A file that cannot be read as such streams. what() is the message for the user and names the
// file.
class RecordedFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How much is read: bytes, and how many there are (0: unknown). May throw, which ends the reading.
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

}  // namespace simbench
