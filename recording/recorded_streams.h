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
  StreamOrigin origin{};
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
