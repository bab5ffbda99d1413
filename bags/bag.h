// A bag as topics and messages, whichever format its file has: rosbag 2.0 (ROS 1, RealSense SDK),
// MCAP and SQLite (rosbag2).
//
// A sink is told each topic, and says how many bytes of each of its messages it needs: stamps stand
// at the front, so images are skipped. Messages come in the order of the file. A topic that several
// publishers write comes once for each.
//
// Whatever the bytes of a file are, a reader takes a bounded amount of memory (kMostBagMemory, less
// than that for usual files), ends, and either throws BagError, because nothing could be read, or
// goes on after the damage and states in BagFacts what was lost. How many messages and inflated
// bytes a file of its size may have is in bags/read_budget.h.
//
//   class Counter final : public BagSink {
//    public:
//     std::size_t on_topic(std::uint32_t, const BagTopic&) override { return 0; }
//     void on_message(const BagMessage&) override { ++messages; }
//     std::uint64_t messages = 0;
//   };
//   Counter counter;
//   const BagFacts facts = read_bag("rig.bag", counter);
//
// Complexity: linear in the file for compressed chunks, else in the number of messages. Sources:
// wiki.ros.org/Bags/Format/2.0, mcap.dev/spec, rosbag2_storage_sqlite3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/time.h"
#include "recording/recorded_streams.h"

namespace simbench::bags {

// A file that is no bag, or of which nothing can be read: "FILE: what was found, what is allowed".
class BagError : public RecordedFileError {
 public:
  using RecordedFileError::RecordedFileError;
};

enum class BagFormat : std::uint8_t { kRosbag, kMcap, kSqlite };
enum class Encoding : std::uint8_t { kRos1, kCdr, kProtobuf, kJson, kOther };
// Whether a topic's messages begin with a stamp that is read (bags/message_types.h).
enum class Headed : std::uint8_t { kUnknown, kNo, kYes };

struct BagTopic {
  std::string name{};       // "/camera/color/image_raw"
  std::string type{};       // as ROS 1 writes it: "sensor_msgs/Image"; empty: unknown
  std::string publisher{};  // where the format knows it
  Encoding encoding = Encoding::kOther;
  Headed headed = Headed::kUnknown;
};

struct BagMessage {
  std::uint32_t topic = 0;  // number of its on_topic() call
  Nanoseconds log_time{};   // of the recorder's clock
  std::uint64_t size = 0;   // of the whole message, bytes
  std::string_view head{};  // its first bytes, as many as the sink asked for and there are; valid
                            // during the call
};

class BagSink {
 public:
  virtual ~BagSink() = default;
  // Before the topic's first message; numbers count from 0. Returns how many bytes of each message
  // are needed: 0 for none, kLeaveOut if on_message() need not be called at all.
  virtual std::size_t on_topic(std::uint32_t number, const BagTopic& topic) = 0;
  virtual void on_message(const BagMessage& message) = 0;
};

inline constexpr std::size_t kLeaveOut = static_cast<std::size_t>(-1);
// The most that a sink may ask for, and a reader holds of a message.
inline constexpr std::size_t kMostHead = std::size_t{1} << 20;
inline constexpr std::size_t kMostTopics = 100'000;
inline constexpr std::size_t kMostBagMemory = std::size_t{160} << 20;

// What a file turned out to be.
struct BagFacts {
  BagFormat format = BagFormat::kRosbag;
  std::string description{};     // "rosbag 2.0, LZ4 chunks"
  bool indexed = false;          // its recorder closed it properly
  std::uint64_t messages = 0;    // read, also of topics that were left out where they were seen
  std::uint64_t lost_bytes = 0;  // of the file, which damage made unreadable
  // By the file's index; unknown without one.
  std::optional<std::uint64_t> lost_messages{};
  std::vector<std::string> notes{};  // what was lost, a line each: "FILE: at byte N: ..."
};

// The format by the first bytes, also of a file that is cut right after them; nothing if it is no
// bag. Throws FileError if the file cannot be read.
std::optional<BagFormat> bag_format(const std::string& path);
std::string_view to_text(BagFormat format);
// Whether the file as a whole is compressed by zstd, as rosbag2 can do; read_bag() unpacks such a
// one among the temporary files, up to 64 MiB and 128 bytes more for each. Throws FileError.
bool is_compressed_whole(const std::string& path);

// `progress` counts bytes of the file; what it throws ends the reading, as what the sink throws.
// Throws BagError.
BagFacts read_bag(const std::string& path, BagSink& sink, const ReadProgress& progress = {});

// The readers themselves.
BagFacts read_rosbag(const std::string& path, BagSink& sink, const ReadProgress& progress);
BagFacts read_mcap(const std::string& path, BagSink& sink, const ReadProgress& progress);
BagFacts read_sqlite_bag(const std::string& path, BagSink& sink, const ReadProgress& progress);

}  // namespace simbench::bags
