// The records of MCAP (mcap.dev/spec), as far as a reader of stamps needs them, and its summary.
//
// A record is an opcode, a length of eight bytes, and so many bytes of content. Numbers are
// little-endian, texts begin with their length: as ROS 1 serialises, so FieldBytes reads them.
//
//   FileBytes file("rig.mcap");
//   McapChannels channels;
//   const McapSummary summary = read_mcap_summary(file, channels);
//   if (summary.messages) ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "bags/bag.h"
#include "recording/byte_stream.h"

namespace simbench::bags {

enum class McapOp : std::uint8_t {
  kInvalid = 0,
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kStatistics = 11,
  kDataEnd = 15,  // the last one that the specification defines
};

inline constexpr std::uint64_t kMcapMagicSize = 8;
inline constexpr std::uint64_t kMcapRecordHead = 9;  // opcode and length
inline constexpr std::uint64_t kMcapMessageHead = 22;

struct McapRecord {
  McapOp op = McapOp::kInvalid;
  std::uint64_t length = 0;  // of the content
};
// False if the end comes first; `ended`: right before the record.
bool read_mcap_record(ByteStream& from, McapRecord& record, bool* ended = nullptr);

struct McapChunkHead {
  std::uint64_t plain_size = 0;
  std::uint32_t plain_crc = 0;     // of the records, plain; 0: not known
  std::string compression{};       // "", "lz4", "zstd"
  std::uint64_t head_size = 0;     // of the content before the records
  std::uint64_t records_size = 0;  // in the file
};
// Whether the next `count` bytes have this checksum; they are read, in steps of 64 kB.
bool checksum_holds(ByteStream& bytes, std::uint64_t count, std::uint32_t expected,
                    const std::function<void()>& on_step = {});

// Nothing if the fields contradict the record's length. `file` stands at the content.
std::optional<McapChunkHead> read_mcap_chunk_head(FileBytes& file, std::uint64_t length);

// The channels and schemas seen so far. Names and their sum are bounded.
//
// The first definition of an id counts. A weak one (of the summary, or of a chunk that is damaged)
// serves where there is no other. A later one that says otherwise is a contradiction: from there on
// nobody knows whose messages the id's are.
class McapChannels {
 public:
  static constexpr std::uint32_t kNoTopic = static_cast<std::uint32_t>(-1);

  struct Channel {
    BagTopic topic{};
    std::uint16_t schema = 0;
    std::uint32_t number = kNoTopic;  // of the sink
    std::size_t wanted = 0;           // what the sink asked for
    bool weak = false;
    bool contradicted = false;
  };
  enum class Taken : std::uint8_t { kYes, kNonsense, kContradiction };

  // Takes the content of a Schema or Channel record; kContradiction once for an id.
  Taken take(const McapRecord& record, ByteStream& content, bool weak = false);
  // "channel 1 stands for /a and for /b"
  const std::string& contradiction() const { return contradiction_; }
  Channel* find(std::uint16_t id);
  // Tells the sink of the channel's topic.
  void announce(Channel& channel, BagSink& sink);
  // Tells it of those that have no messages, too.
  void announce_all(BagSink& sink);
  bool empty() const { return channels_.empty(); }

 private:
  Taken take_schema(std::string_view bytes);
  Taken take_channel(std::string_view bytes, bool weak);
  bool has_room(std::size_t size);

  struct Schema {
    std::string name{};
    std::string definition{};  // its begin
  };

  std::map<std::uint16_t, Schema> schemas_{};
  std::map<std::uint16_t, Channel> channels_{};
  std::string contradiction_{};
  std::uint32_t announced_ = 0;
  std::size_t text_bytes_ = 0;
};

// The end of a file, if its writer closed it.
struct McapSummary {
  bool closed = false;            // a footer and the last magic bytes
  bool damaged = false;           // there is a summary, but its checksum is another
  std::uint64_t data_end = 0;     // where the footer begins, or the end of the file
  std::uint64_t checked_end = 0;  // of the bytes that data_crc is of; 0: no checksum
  std::uint32_t data_crc = 0;
  std::optional<std::uint64_t> messages{};  // by its statistics
};
// Also takes the summary's channels. Throws FileError.
McapSummary read_mcap_summary(FileBytes& file, McapChannels& channels);

}  // namespace simbench::bags
