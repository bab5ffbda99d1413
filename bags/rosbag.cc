// rosbag 2.0: chunks of messages, then the index: connections, and what each chunk holds.
//
// The index comes first: it names the topics before their messages and tells which chunks hold none
// that is wanted. Without one (a recorder that was killed) the chunks themselves name the topics.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <vector>

#include "bags/bag.h"
#include "bags/damage_notes.h"
#include "bags/message_types.h"
#include "bags/read_budget.h"
#include "bags/rosbag_records.h"
#include "recording/byte_stream.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::uint64_t kFirstRecord = 13;  // after "#ROSBAG V2.0\n"
constexpr std::size_t kMostConnectionData = std::size_t{1} << 20;
constexpr std::size_t kMostChunks = 2'000'000;
constexpr std::uint64_t kProgressStep = std::uint64_t{1} << 20;

// What the index says of a chunk.
struct IndexedChunk {
  std::uint64_t position = 0;
  std::uint64_t messages = 0;
  bool wanted = true;
};

class RosbagReading {
 public:
  RosbagReading(const std::string& path, BagSink& sink, const ReadProgress& progress)
      : path_(path),
        file_(path),
        sink_(sink),
        progress_(progress),
        notes_(path),
        budget_(file_.size()) {
    facts_.format = BagFormat::kRosbag;
  }

  BagFacts read() {
    read_bag_header();
    read_index();
    try {
      read_records();
    } catch (const BudgetSpent& spent) {
      notes_.add(spent.what());
    }
    finish();
    return std::move(facts_);
  }

 private:
  struct Connection {
    std::uint32_t topic = 0;
    std::size_t head = kLeaveOut;
  };

  void note(std::uint64_t position, const std::string& text) { notes_.add(position, text); }

  void read_bag_header();
  void read_index();
  bool read_chunk_info(const RecordHeader& record);
  bool read_connection(const RecordHeader& record, ByteStream& stream);
  void read_records();
  std::uint64_t read_record_at(std::uint64_t position);
  std::uint64_t read_chunk(std::uint64_t position, const RecordHeader& record);
  bool read_inflated(std::uint64_t position, const RecordHeader& record, bool lz4,
                     ByteStream& bytes);
  bool read_chunk_content(std::uint64_t position, ByteStream& stream);
  bool read_message(const RecordHeader& record, ByteStream& stream);
  std::uint64_t next_chunk_after(std::uint64_t position);
  void finish();

  const IndexedChunk* indexed_chunk(std::uint64_t position) const {
    const auto found =
        std::lower_bound(chunks_.begin(), chunks_.end(), position,
                         [](const IndexedChunk& c, std::uint64_t p) { return c.position < p; });
    return found != chunks_.end() ? &*found : nullptr;
  }

  const std::string& path_;
  FileBytes file_;
  BagSink& sink_;
  const ReadProgress& progress_;
  BagFacts facts_;
  DamageNotes notes_;
  ReadBudget budget_;
  std::map<std::uint32_t, Connection> connections_;
  std::vector<IndexedChunk> chunks_;  // by position
  std::uint64_t index_at_ = 0;        // 0: none
  std::uint64_t indexed_messages_ = 0;
  std::size_t indexed_connections_ = 0;
  std::size_t indexed_chunks_ = 0;
  std::string head_;
  std::string connection_data_;
  std::map<std::string, std::uint64_t> compressions_;
  std::uint32_t topics_ = 0;
};

void RosbagReading::read_bag_header() {
  file_.seek(kFirstRecord);
  RecordHeader record;
  if (!record.read(file_) || record.kind() != RecordKind::kBagHeader) {
    // The rest may be fine all the same.
    if (file_.size() <= kFirstRecord) throw BagError(path_ + ": the bag is empty");
    note(kFirstRecord, "the bag's own header is damaged");
    return;
  }
  if (const auto encryptor = field_of(record.fields(), "encryptor");
      encryptor && !encryptor->empty()) {
    throw BagError(fmt::format(
        "{}: is encrypted ({}), allowed: a plain bag; decrypt it with ROS' own tools first", path_,
        printable_name(*encryptor)));
  }
  index_at_ = u64_field(record.fields(), "index_pos").value_or(0);
  indexed_connections_ = u32_field(record.fields(), "conn_count").value_or(0);
  indexed_chunks_ = u32_field(record.fields(), "chunk_count").value_or(0);
  if (index_at_ > file_.size()) index_at_ = 0;
}

// Trusts the index only as a whole.
void RosbagReading::read_index() {
  if (index_at_ == 0) return;
  file_.seek(index_at_);
  RecordHeader record;
  bool sound = true;
  while (sound && record.read(file_)) {
    if (record.kind() == RecordKind::kConnection) {
      sound = read_connection(record, file_);
    } else if (record.kind() == RecordKind::kChunkInfo) {
      sound = read_chunk_info(record);
    } else {
      sound = false;
    }
  }
  facts_.indexed = sound && record.ended() && connections_.size() == indexed_connections_ &&
                   chunks_.size() == indexed_chunks_;
  std::sort(chunks_.begin(), chunks_.end(),
            [](const IndexedChunk& a, const IndexedChunk& b) { return a.position < b.position; });
  if (facts_.indexed) return;
  note(index_at_, "the index is damaged; the messages are found without it");
  chunks_.clear();
  index_at_ = 0;
}

bool RosbagReading::read_chunk_info(const RecordHeader& record) {
  const auto position = u64_field(record.fields(), "chunk_pos");
  const auto count = u32_field(record.fields(), "count");
  if (!position || !count || record.data_size() != std::uint64_t{*count} * 8) return false;
  if (*count > kMostTopics || chunks_.size() == kMostChunks) return false;
  IndexedChunk chunk{.position = *position, .wanted = false};
  for (std::uint32_t i = 0; i < *count; ++i) {
    std::array<char, 8> entry{};
    if (!file_.read_exactly(entry.data(), entry.size())) return false;
    const auto known = connections_.find(u32_of(entry.data()));
    if (known == connections_.end() || known->second.head != kLeaveOut) chunk.wanted = true;
    chunk.messages += u32_of(entry.data() + 4);
  }
  indexed_messages_ += chunk.messages;
  chunks_.push_back(chunk);
  return true;
}

// A connection comes in a chunk and in the index; the first one counts.
bool RosbagReading::read_connection(const RecordHeader& record, ByteStream& stream) {
  const auto number = u32_field(record.fields(), "conn");
  const auto topic = field_of(record.fields(), "topic");
  if (!number || !topic || record.data_size() > kMostConnectionData) return false;
  connection_data_.resize(record.data_size());
  if (!stream.read_exactly(connection_data_.data(), connection_data_.size())) return false;
  if (connections_.contains(*number)) return true;
  if (connections_.size() == kMostTopics) return false;
  const auto text = [this](std::string_view name) {
    return std::string(field_of(connection_data_, name).value_or(""));
  };
  Connection& added = connections_[*number];
  added.topic = topics_++;
  BagTopic described{.name = std::string(*topic),
                     .type = text("type"),
                     .publisher = text("callerid"),
                     .encoding = Encoding::kRos1};
  described.headed = headed_by(
      described, field_of(connection_data_, "message_definition").value_or(std::string_view()));
  added.head = sink_.on_topic(added.topic, described);
  return true;
}

void RosbagReading::read_records() {
  std::uint64_t position = kFirstRecord;
  std::uint64_t reported = 0;
  const std::uint64_t end = index_at_ > 0 ? index_at_ : file_.size();
  while (position < end) {
    if (progress_ && position - reported >= kProgressStep) {
      reported = position;
      progress_(position, file_.size());
    }
    const std::uint64_t next = read_record_at(position);
    position = std::max(next, position + 1);
  }
}

// Returns the position of the next record.
std::uint64_t RosbagReading::read_record_at(std::uint64_t position) {
  file_.seek(position);
  RecordHeader record;
  if (!record.read(file_)) {
    const std::uint64_t next = next_chunk_after(position);
    note(position, fmt::format("no record; {} bytes are lost", next - position));
    facts_.lost_bytes += next - position;
    return next;
  }
  const std::uint64_t end = position + record.size() + record.data_size();
  switch (record.kind()) {
    case RecordKind::kChunk:
      return read_chunk(position, record);
    case RecordKind::kConnection:
      if (!read_connection(record, file_)) note(position, "a connection that makes no sense");
      break;
    case RecordKind::kMessage:
      if (!read_message(record, file_)) note(position, "a message that makes no sense");
      break;
    default:
      break;
  }
  if (end <= file_.size()) return end;
  const std::uint64_t next = next_chunk_after(position + 1);
  note(position, fmt::format("a record that is cut off; {} bytes are lost", next - position));
  facts_.lost_bytes += next - position;
  return next;
}

std::uint64_t RosbagReading::read_chunk(std::uint64_t position, const RecordHeader& record) {
  const std::uint64_t data_at = position + record.size();
  const IndexedChunk* indexed = indexed_chunk(position);
  if (indexed != nullptr && indexed->position == position && !indexed->wanted) {
    facts_.messages += indexed->messages;
    return data_at + record.data_size();
  }
  // A size beyond the next chunk is wrong.
  const IndexedChunk* following = indexed_chunk(position + 1);
  const std::uint64_t limit = following != nullptr ? following->position
                              : index_at_ > 0      ? index_at_
                                                   : file_.size();
  const std::uint64_t declared_end = data_at + record.data_size();
  const std::uint64_t end = std::min(declared_end, std::max(limit, data_at));
  const std::string compression(field_of(record.fields(), "compression").value_or("none"));
  LimitedBytes bytes(file_, end - data_at);
  bool whole = false;
  ++compressions_[compression];
  try {
    if (compression == "none") {
      whole = read_chunk_content(position, bytes);
    } else if (compression == "lz4" || compression == "bz2") {
      whole = read_inflated(position, record, compression == "lz4", bytes);
    } else {
      note(position, fmt::format("a chunk compressed with {}, allowed: none, lz4, bz2",
                                 quoted_bytes(compression)));
    }
  } catch (const InflateError& error) {
    note(position, fmt::format("a chunk that is damaged: {}", error.what()));
  }
  if (!whole) facts_.lost_bytes += bytes.left();
  if (whole && end == declared_end) return end;
  if (end < declared_end) note(position, "a chunk that is cut off, or whose size is wrong");
  // The size may be what is wrong: without an index, looks for the next chunk inside, too.
  return index_at_ > 0 ? end : next_chunk_after(data_at);
}

// A chunk states its plain size.
bool RosbagReading::read_inflated(std::uint64_t position, const RecordHeader& record, bool lz4,
                                  ByteStream& bytes) {
  constexpr std::uint64_t kBzip2Weight = 8;
  const auto stream = inflated(lz4 ? Compression::kLz4 : Compression::kBzip2, bytes);
  const std::uint64_t declared =
      u32_field(record.fields(), "size").value_or(std::numeric_limits<std::uint32_t>::max());
  BudgetedBytes plain(*stream, declared, budget_, lz4 ? 1 : kBzip2Weight);
  if (!read_chunk_content(position, plain)) return false;
  if (plain.left() > 0 || !plain.has_more()) return true;
  note(position, fmt::format("a chunk becomes more than the {} bytes that it declares; the rest of "
                             "it is lost",
                             declared));
  return false;
}

// False if a part makes no sense; what came before was passed on.
bool RosbagReading::read_chunk_content(std::uint64_t position, ByteStream& stream) {
  RecordHeader record;
  while (record.read(stream)) {
    const bool sound = record.kind() == RecordKind::kConnection ? read_connection(record, stream)
                       : record.kind() == RecordKind::kMessage  ? read_message(record, stream)
                                                                : false;
    if (sound) continue;
    note(position, "a chunk with a record that makes no sense; the rest of the chunk is lost");
    return false;
  }
  if (record.ended()) return true;
  note(position, "a chunk that ends in a record, or is damaged; the rest of it is lost");
  return false;
}

bool RosbagReading::read_message(const RecordHeader& record, ByteStream& stream) {
  const auto number = u32_field(record.fields(), "conn");
  const auto time = time_field(record.fields(), "time");
  const auto known = number ? connections_.find(*number) : connections_.end();
  if (!time || known == connections_.end()) return false;
  budget_.take_message();
  const std::size_t asked = known->second.head;
  const std::size_t wanted =
      asked == kLeaveOut ? 0 : std::min<std::size_t>({asked, kMostHead, record.data_size()});
  head_.resize(wanted);
  if (!stream.read_exactly(head_.data(), wanted)) return false;
  const std::uint64_t rest = record.data_size() - wanted;
  if (stream.skip(rest) != rest) return false;
  ++facts_.messages;
  if (asked == kLeaveOut) return true;
  sink_.on_message(
      {.topic = known->second.topic, .log_time = *time, .size = record.data_size(), .head = head_});
  return true;
}

// The position of the next chunk at or after this one: by the index, else by its look.
std::uint64_t RosbagReading::next_chunk_after(std::uint64_t position) {
  if (index_at_ > 0) {
    const IndexedChunk* next = indexed_chunk(position + 1);
    return next != nullptr ? next->position : index_at_;
  }
  constexpr std::string_view kMark{"\x04\0\0\0op=\x05", 8};
  constexpr std::size_t kBlock = std::size_t{64} << 10;
  constexpr std::size_t kBefore = 256;  // of a header, before its mark
  std::string block;
  for (std::uint64_t at = position; at < file_.size(); at += kBlock) {
    file_.seek(at);
    block.resize(kBlock + 2 * kBefore);
    block.resize(file_.read_up_to(block.data(), block.size()));
    for (std::size_t mark = block.find(kMark); mark != std::string::npos;
         mark = block.find(kMark, mark + 1)) {
      for (std::size_t back = 4; back <= std::min<std::size_t>(mark, kBefore); ++back) {
        const std::size_t begin = mark - back;
        const std::size_t length = u32_of(block.data() + begin);
        if (length < back - 4 + kMark.size() || length > 2 * kBefore) continue;
        file_.seek(at + begin);
        RecordHeader record;
        if (!record.read(file_) || record.kind() != RecordKind::kChunk) continue;
        if (!field_of(record.fields(), "compression")) continue;
        return at + begin;
      }
    }
  }
  return file_.size();
}

void RosbagReading::finish() {
  std::string chunks;
  for (const auto& [compression, count] : compressions_) {
    chunks += fmt::format("{}{}", chunks.empty() ? "" : ", ", printable_name(compression));
  }
  facts_.description =
      fmt::format("rosbag 2.0, chunks: {}", chunks.empty() ? "none that was read" : chunks);
  if (facts_.indexed) {
    facts_.lost_messages =
        indexed_messages_ > facts_.messages ? indexed_messages_ - facts_.messages : 0;
  } else if (index_at_ == 0) {
    notes_.add(
        "has no index, as of a recorder that was killed; its messages were found without one");
  }
  facts_.notes = notes_.take();
  if (topics_ == 0) throw BagError(path_ + ": found no topic in this bag");
}

}  // namespace

BagFacts read_rosbag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  return RosbagReading(path, sink, progress).read();
}

}  // namespace simbench::bags
