// MCAP, read from the front; its summary only says what should be there.
//
// An uncompressed chunk is entered: the records in it are read like those outside, so that large
// messages are skipped by seeking, and damage in it is passed by the same search for the next
// record. Chunks' checksums are not looked at: they would need every byte of every image.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "bags/bag.h"
#include "bags/damage_notes.h"
#include "bags/fields.h"
#include "bags/mcap_records.h"
#include "recording/byte_stream.h"

namespace simbench::bags {
namespace {

constexpr std::uint64_t kProgressBytes = std::uint64_t{8} << 20;
constexpr std::size_t kSearchWindow = std::size_t{64} << 10;

bool is_defined(McapOp op) { return op >= McapOp::kHeader && op <= McapOp::kDataEnd; }

Nanoseconds log_time_of(std::uint64_t ns) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return Nanoseconds(static_cast<std::int64_t>(std::min(ns, kMost)));
}

class McapReader {
 public:
  McapReader(const std::string& path, BagSink& sink, const ReadProgress& progress)
      : path_(path), sink_(sink), progress_(progress), file_(path), notes_(path) {}

  BagFacts read();

 private:
  void walk();
  void read_record(const McapRecord& record, std::uint64_t begin);
  void read_chunk(std::uint64_t begin, std::uint64_t length);
  void read_compressed(const McapChunkHead& head, std::uint64_t begin, std::uint64_t size);
  bool read_inner(ByteStream& plain);
  // False if the message is not whole.
  bool read_message(ByteStream& from, std::uint64_t length);
  void take_definition(const McapRecord& record, ByteStream& content, std::uint64_t begin);
  void pass_damage(std::uint64_t begin, const std::string& what);
  std::optional<std::uint64_t> next_record(std::uint64_t from, std::uint64_t limit);
  bool is_plausible(std::uint64_t at, std::uint64_t limit);
  void tell_progress(std::uint64_t position);
  void conclude(const McapSummary& summary);

  const std::string& path_;
  BagSink& sink_;
  const ReadProgress& progress_;
  FileBytes file_;
  DamageNotes notes_;
  McapChannels channels_{};
  BagFacts facts_{.format = BagFormat::kMcap};
  std::uint64_t end_ = 0;      // of the records
  std::uint64_t limit_ = 0;    // of the chunk that is being read, or end_
  std::uint64_t told_ = 0;     // to `progress`
  std::uint64_t unknown_ = 0;  // messages of channels that are nowhere described
  std::set<std::string> compressions_{};
  std::string refused_{};  // the first chunk of an unknown compression
  std::vector<char> head_{};
};

BagFacts McapReader::read() {
  const McapSummary summary = read_mcap_summary(file_, channels_);
  end_ = limit_ = summary.data_end;
  if (file_.size() <= kMcapMagicSize) {
    throw BagError(path_ + ": found MCAP's first bytes alone, allowed: a bag with messages");
  }
  file_.seek(kMcapMagicSize);
  walk();
  channels_.announce_all(sink_);
  conclude(summary);
  return std::move(facts_);
}

void McapReader::walk() {
  McapRecord record;
  while (file_.position() < end_) {
    if (file_.position() >= limit_) limit_ = end_;
    const std::uint64_t begin = file_.position();
    tell_progress(begin);
    if (limit_ - begin < kMcapRecordHead || !read_mcap_record(file_, record)) {
      pass_damage(begin, "the end of a record is missing");
      continue;
    }
    if (record.op == McapOp::kInvalid) {
      pass_damage(begin, "found no record");
      continue;
    }
    const std::uint64_t left = limit_ - begin - kMcapRecordHead;
    if (record.op == McapOp::kChunk && limit_ == end_) {
      read_chunk(begin, record.length);
    } else if (record.length > left) {
      pass_damage(begin, "found a record of " + std::to_string(record.length) + " bytes, but " +
                             std::to_string(left) + " are left");
    } else {
      read_record(record, begin);
    }
  }
}

void McapReader::read_record(const McapRecord& record, std::uint64_t begin) {
  const std::uint64_t next = begin + kMcapRecordHead + record.length;
  if (record.op == McapOp::kMessage) {
    if (!read_message(file_, record.length)) pass_damage(begin, "found a message without its head");
  } else if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) {
    take_definition(record, file_, begin);
  }
  // Within its buffer the file need not be sought.
  if (file_.position() < next) file_.skip(next - file_.position());
}

void McapReader::take_definition(const McapRecord& record, ByteStream& content,
                                 std::uint64_t begin) {
  LimitedBytes part(content, record.length);
  if (!channels_.take(record, part)) {
    notes_.add(begin, record.op == McapOp::kSchema ? "the schema makes no sense"
                                                   : "the channel makes no sense");
    facts_.lost_bytes += kMcapRecordHead + record.length;
  }
  part.skip(record.length);
}

void McapReader::read_chunk(std::uint64_t begin, std::uint64_t length) {
  const std::optional<McapChunkHead> head = read_mcap_chunk_head(file_, length);
  const std::uint64_t records = begin + kMcapRecordHead + (head ? head->head_size : 0);
  if (!head || records > end_) {
    pass_damage(begin, "the lengths of a chunk contradict each other");
    return;
  }
  const std::uint64_t size = std::min(head->records_size, end_ - records);
  if (size < head->records_size) {
    notes_.add(begin, "the file ends in a chunk: " + std::to_string(head->records_size - size) +
                          " of its bytes are missing");
  }
  file_.seek(records);
  if (head->compression.empty()) {
    compressions_.insert("uncompressed");
    limit_ = records + size;
    return;
  }
  if (head->compression == "lz4" || head->compression == "zstd") {
    compressions_.insert(head->compression == "lz4" ? "LZ4" : "zstd");
    read_compressed(*head, begin, size);
  } else {
    const std::string what = "found a chunk that is compressed (or encrypted) by '" +
                             head->compression + "', allowed: none, lz4, zstd";
    if (refused_.empty()) refused_ = "at byte " + std::to_string(begin) + ": " + what;
    notes_.add(begin, what);
    facts_.lost_bytes += size;
  }
  file_.seek(records + size);
}

void McapReader::read_compressed(const McapChunkHead& head, std::uint64_t begin,
                                 std::uint64_t size) {
  const std::uint64_t records = file_.position();
  LimitedBytes compressed(file_, size);
  const std::unique_ptr<ByteStream> plain =
      inflated(head.compression == "lz4" ? Compression::kLz4 : Compression::kZstd, compressed);
  std::string reason;
  try {
    if (read_inner(*plain)) return;
    reason = "a record in it is not whole";
  } catch (const InflateError& error) {
    reason = error.what();
  }
  notes_.add(begin, "the chunk is damaged: " + reason);
  // What was in the decompressor's hands when it failed is lost as well.
  const std::uint64_t taken = std::min(file_.position() - records, size);
  facts_.lost_bytes += size - taken + std::min<std::uint64_t>(taken, kSearchWindow);
}

// The records of a compressed chunk; false if they do not end with it.
bool McapReader::read_inner(ByteStream& plain) {
  McapRecord record;
  for (;;) {
    bool ended = false;
    if (!read_mcap_record(plain, record, &ended)) return ended;
    if (record.op == McapOp::kInvalid) return false;
    if (record.op == McapOp::kMessage) {
      if (!read_message(plain, record.length)) return false;
    } else {
      LimitedBytes content(plain, record.length);
      if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) {
        if (!channels_.take(record, content)) return false;
      }
      // A record of no interest: one that is not whole leaves nothing after it.
      content.skip(record.length);
    }
  }
}

bool McapReader::read_message(ByteStream& from, std::uint64_t length) {
  std::array<char, kMcapMessageHead> fixed{};
  if (length < fixed.size() || !from.read_exactly(fixed.data(), fixed.size())) return false;
  FieldBytes fields({fixed.data(), fixed.size()}, Encoding::kRos1);
  const std::uint16_t id = fields.u16();
  fields.u32();
  const Nanoseconds log_time = log_time_of(fields.u64());
  const std::uint64_t size = length - fixed.size();
  McapChannels::Channel* channel = channels_.find(id);
  if (channel == nullptr) {
    ++unknown_;
    return from.skip(size) == size;
  }
  channels_.announce(*channel, sink_);
  const std::size_t wanted =
      channel->wanted == kLeaveOut
          ? 0
          : static_cast<std::size_t>(std::min<std::uint64_t>(channel->wanted, size));
  if (head_.size() < wanted) head_.resize(wanted);
  if (!from.read_exactly(head_.data(), wanted)) return false;
  if (from.skip(size - wanted) != size - wanted) return false;
  ++facts_.messages;
  if (channel->wanted != kLeaveOut) {
    sink_.on_message({.topic = channel->number,
                      .log_time = log_time,
                      .size = size,
                      .head = {head_.data(), wanted}});
  }
  return true;
}

// Goes on at the next record that is to be believed.
void McapReader::pass_damage(std::uint64_t begin, const std::string& what) {
  const std::optional<std::uint64_t> next = next_record(begin + 1, limit_);
  const std::uint64_t to = next.value_or(limit_);
  facts_.lost_bytes += to - begin;
  notes_.add(begin, what + "; " + std::to_string(to - begin) + " bytes were passed over");
  file_.seek(to);
}

std::optional<std::uint64_t> McapReader::next_record(std::uint64_t from, std::uint64_t limit) {
  std::vector<char> window(kSearchWindow);
  while (from < limit && limit - from >= kMcapRecordHead) {
    tell_progress(from);
    file_.seek(from);
    const auto most =
        static_cast<std::size_t>(std::min<std::uint64_t>(limit - from, window.size()));
    const std::size_t size = file_.read_up_to(window.data(), most);
    if (size < kMcapRecordHead) break;
    for (std::size_t i = 0; i + kMcapRecordHead <= size; ++i) {
      // The highest bytes of a length are zero in any file that fits on a disk.
      if (!is_defined(static_cast<McapOp>(static_cast<std::uint8_t>(window[i]))) ||
          window[i + 7] != 0 || window[i + 8] != 0) {
        continue;
      }
      if (is_plausible(from + i, limit)) return from + i;
    }
    from += size - (kMcapRecordHead - 1);
  }
  return std::nullopt;
}

// A chunk whose lengths agree, or a record with another one behind it.
bool McapReader::is_plausible(std::uint64_t at, std::uint64_t limit) {
  McapRecord record;
  file_.seek(at);
  if (!read_mcap_record(file_, record)) return false;
  const std::uint64_t content = at + kMcapRecordHead;
  if (record.op == McapOp::kChunk) return read_mcap_chunk_head(file_, record.length).has_value();
  if (record.length > limit - content || record.length < 4) return false;
  if (record.op == McapOp::kMessage) {
    std::array<char, 2> id{};
    if (record.length < kMcapMessageHead || !file_.read_exactly(id.data(), id.size())) return false;
    FieldBytes fields({id.data(), id.size()}, Encoding::kRos1);
    if (channels_.find(fields.u16()) == nullptr) return false;
  }
  const std::uint64_t next = content + record.length;
  if (next == limit) return true;
  if (limit - next < kMcapRecordHead) return false;
  file_.seek(next);
  return read_mcap_record(file_, record) && is_defined(record.op) &&
         (record.length <= limit - next - kMcapRecordHead || record.op == McapOp::kChunk);
}

void McapReader::tell_progress(std::uint64_t position) {
  if (!progress_ || position < told_ + kProgressBytes) return;
  told_ = position;
  progress_(position, file_.size());
}

void McapReader::conclude(const McapSummary& summary) {
  facts_.description = "MCAP";
  const char* before = ", ";
  for (const std::string& name : compressions_) {
    facts_.description += std::exchange(before, " and ") + name;
  }
  if (!compressions_.empty()) facts_.description += " chunks";
  facts_.indexed = summary.closed;
  if (!summary.closed) notes_.add("it was not closed by its recorder, or is cut off: no footer");
  if (summary.damaged) notes_.add("its summary is damaged and was left aside");
  if (unknown_ > 0) {
    notes_.add(std::to_string(unknown_) + " messages are of channels that are nowhere described");
  }
  if (summary.messages) {
    facts_.lost_messages =
        *summary.messages - std::min<std::uint64_t>(*summary.messages, facts_.messages);
    if (facts_.messages > *summary.messages) {
      notes_.add("its statistics state " + std::to_string(*summary.messages) + " messages, " +
                 std::to_string(facts_.messages) + " were read");
    }
  }
  facts_.notes = notes_.take();
  if (facts_.messages > 0 || facts_.lost_bytes == 0) return;
  if (!refused_.empty()) throw BagError(path_ + ": " + refused_);
  if (channels_.empty()) throw BagError(facts_.notes.front());
}

}  // namespace

BagFacts read_mcap(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  return McapReader(path, sink, progress).read();
}

}  // namespace simbench::bags
