// Writers of small bags, for tests: MCAP, rosbag2's SQLite, and the messages in them. They write
// what the formats say and nothing else, so that a test knows each byte's meaning.
//
//   McapWriter mcap({.compression = "lz4", .chunk_bytes = 4096});
//   const std::uint16_t left = mcap.channel("/left/image", "sensor_msgs/msg/Image", "cdr");
//   mcap.message(left, 1'000, cdr_header(3, 5, "left") + pixels);
//   put(path, mcap.close());
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bags/bag.h"
#include "tests/deflated.h"

namespace simbench::bags {

// Little-endian bytes.
std::string bytes_of(std::uint64_t value, std::size_t size);
std::string length_and(std::string_view text);  // four bytes of length, the text

// std_msgs/Header as it is serialised.
std::string ros1_header(std::uint32_t sequence, std::uint32_t s, std::uint32_t ns,
                        std::string_view frame);
std::string cdr_header(std::uint32_t s, std::uint32_t ns, std::string_view frame);

// Why read_bag() refuses a file; "accepted" if it does not.
std::string bag_refusal(const std::string& path);

struct McapOptions {
  std::string compression{};
  std::size_t chunk_bytes = 0;  // 0: without chunks
  bool summary = true;
  bool checksums = true;       // of chunks
  bool data_checksum = false;  // of all before DataEnd; only if nothing is taken out before
};

class McapWriter {
 public:
  explicit McapWriter(McapOptions options);

  // A text `definition` is of ros2msg; empty: the schema has none.
  std::uint16_t channel(std::string_view topic, std::string_view type, std::string_view encoding,
                        std::string_view publisher = {},
                        std::string_view definition = "std_msgs/Header header");
  // Into the chunk: a record as it is.
  void record(std::uint8_t op, std::string_view content);
  void message(std::uint16_t channel, std::uint64_t log_time_ns, std::string_view data);
  void end_chunk();
  // What is finished so far, taken out: for files that are larger than memory.
  std::string take_finished();
  // The rest of the file (all of it, if nothing was taken out).
  std::string close();

 private:
  McapOptions options_;
  std::string finished_;
  std::uint64_t taken_ = 0;
  std::string chunk_{};
  std::string definitions_{};  // repeated in the summary
  std::string chunk_indexes_{};
  std::uint64_t messages_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint16_t channels_ = 0;
};
std::string mcap_record(std::uint8_t op, std::string_view content);

// rosbag2's tables, written by SQLite. Topics count from 1, as messages do.
class SqliteBagWriter {
 public:
  explicit SqliteBagWriter(const std::string& path, bool indexed = true, int page_bytes = 4096);
  std::int64_t topic(const std::string& name, const std::string& type,
                     const std::string& format = "cdr");
  void message(std::int64_t topic, std::int64_t timestamp_ns, std::string_view data);
  void run(const std::string& sql);
  void close();  // once; without it nothing is in the file

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  struct Finish {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3, Close> database_{};
  std::unique_ptr<sqlite3_stmt, Finish> insert_{};
  std::int64_t topics_ = 0;
};

// All that a reader tells.
class KeptBag final : public BagSink {
 public:
  struct Message {
    std::uint32_t topic = 0;
    std::int64_t log_time_ns = 0;
    std::uint64_t size = 0;
    std::string head{};
    friend bool operator==(const Message&, const Message&) = default;
  };
  explicit KeptBag(std::size_t wanted = 64) : wanted_(wanted) {}
  std::size_t on_topic(std::uint32_t number, const BagTopic& topic) override;
  void on_message(const BagMessage& message) override;

  std::vector<BagTopic> topics{};
  std::vector<Message> messages{};

 private:
  std::size_t wanted_;
};

}  // namespace simbench::bags
