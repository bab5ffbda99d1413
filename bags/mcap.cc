// MCAP, read from the front; its summary only says what should be there.
//
// An uncompressed chunk is entered: the records in it are read like those outside, so that large
// messages are skipped by seeking, and damage in it is passed by the same search for the next
// record. A compressed chunk is held if it is not too large.
//
// Checksums are compared where there are any: a chunk with another one is left out, since one of
// its stamps may be what was changed. That of the whole data section says no place.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "bags/bag.h"
#include "bags/checksum.h"
#include "bags/damage_notes.h"
#include "bags/fields.h"
#include "bags/mcap_records.h"
#include "bags/read_budget.h"
#include "recording/byte_stream.h"
#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::uint64_t kProgressBytes = std::uint64_t{8} << 20;
constexpr std::uint64_t kMostHeld = std::uint64_t{32} << 20;  // of a chunk, plain
constexpr std::size_t kMostTopicsNamed = 5;
constexpr std::size_t kSearchWindow = std::size_t{64} << 10;

bool is_defined(McapOp op) { return op >= McapOp::kHeader && op <= McapOp::kDataEnd; }

Nanoseconds log_time_of(std::uint64_t ns) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return Nanoseconds(static_cast<std::int64_t>(std::min(ns, kMost)));
}

class McapReader {
 public:
  McapReader(const std::string& path, BagSink& sink, const ReadProgress& progress)
      : path_(path),
        sink_(sink),
        progress_(progress),
        file_(path),
        notes_(path),
        budget_(file_.size()) {}

  BagFacts read();

 private:
  void walk();
  void read_record(const McapRecord& record, std::uint64_t begin);
  void read_chunk(std::uint64_t begin, std::uint64_t length);
  void enter_plain(const McapChunkHead& head, std::uint64_t begin, std::uint64_t size);
  void read_compressed(const McapChunkHead& head, std::uint64_t begin, std::uint64_t size);
  bool large_chunk_holds(const McapChunkHead& head, std::uint64_t size);
  // Returns what is wrong with the chunk; empty: nothing, or all that there is was said.
  std::string read_held(const McapChunkHead& head, std::uint64_t begin, std::uint64_t size,
                        BudgetedBytes& plain);
  std::string read_streamed(const McapChunkHead& head, BudgetedBytes& plain);
  void leave_out(ByteStream& content, std::uint64_t begin, std::uint64_t size);
  bool read_inner(ByteStream& plain);
  // False if the message is not whole.
  bool read_message(ByteStream& from, std::uint64_t length);
  void take_definition(const McapRecord& record, ByteStream& content, std::uint64_t begin);
  void pass_damage(std::uint64_t begin, const std::string& what);
  std::optional<std::uint64_t> next_record(std::uint64_t from, std::uint64_t limit);
  bool is_plausible(std::uint64_t at, std::uint64_t limit);
  void tell_progress(std::uint64_t position);
  void sum_data(std::uint64_t to);
  void conclude();

  const std::string& path_;
  BagSink& sink_;
  const ReadProgress& progress_;
  FileBytes file_;
  DamageNotes notes_;
  ReadBudget budget_;
  McapChannels channels_{};
  McapSummary summary_{};
  std::optional<FileBytes> behind_{};  // follows the reading, for the data section's checksum
  Checksum data_sum_{};
  BagFacts facts_{.format = BagFormat::kMcap};
  std::uint64_t end_ = 0;      // of the records
  std::uint64_t limit_ = 0;    // of the chunk that is being read, or end_
  std::uint64_t told_ = 0;     // to `progress`
  std::uint64_t unknown_ = 0;  // messages of channels that are nowhere described
  std::uint64_t contradicted_ = 0;
  std::set<std::string> compressions_{};
  std::string refused_{};  // the first chunk of an unknown compression
  std::vector<char> head_{};
  std::vector<char> held_{};
};

BagFacts McapReader::read() {
  summary_ = read_mcap_summary(file_, channels_);
  end_ = limit_ = summary_.data_end;
  if (summary_.checked_end > 0) behind_.emplace(path_);
  if (file_.size() <= kMcapMagicSize) {
    throw BagError(path_ + ": found MCAP's first bytes alone, allowed: a bag with messages");
  }
  file_.seek(kMcapMagicSize);
  try {
    walk();
    sum_data(summary_.checked_end);
    if (behind_ && data_sum_.value() != summary_.data_crc) {
      notes_.add("the checksum of its data section differs: something before byte " +
                 std::to_string(summary_.checked_end) + " was changed");
    }
  } catch (const BudgetSpent& spent) {
    notes_.add(file_.position(), spent.what());
  }
  channels_.announce_all(sink_);
  conclude();
  return std::move(facts_);
}

void McapReader::walk() {
  McapRecord record;
  while (file_.position() < end_) {
    if (file_.position() >= limit_) limit_ = end_;
    const std::uint64_t begin = file_.position();
    tell_progress(begin);
    if (begin > kProgressBytes) sum_data(begin - kProgressBytes);
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
  switch (channels_.take(record, part)) {
    case McapChannels::Taken::kYes:
      break;
    case McapChannels::Taken::kNonsense:
      notes_.add(begin, record.op == McapOp::kSchema ? "the schema makes no sense"
                                                     : "the channel makes no sense");
      facts_.lost_bytes += kMcapRecordHead + record.length;
      break;
    case McapChannels::Taken::kContradiction:
      notes_.add(begin, channels_.contradiction() + "; its messages from here on are left out");
      break;
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
    enter_plain(*head, begin, size);
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

void McapReader::enter_plain(const McapChunkHead& head, std::uint64_t begin, std::uint64_t size) {
  const std::uint64_t records = file_.position();
  const bool checked = head.plain_crc != 0 && size == head.records_size;
  if (checked &&
      !checksum_holds(file_, size, head.plain_crc, [this] { tell_progress(file_.position()); })) {
    file_.seek(records);
    LimitedBytes content(file_, size);
    leave_out(content, begin, size);
    file_.seek(records + size);
    return;
  }
  file_.seek(records);
  limit_ = records + size;
}

void McapReader::read_compressed(const McapChunkHead& head, std::uint64_t begin,
                                 std::uint64_t size) {
  const std::uint64_t records = file_.position();
  const bool held = head.plain_size <= kMostHeld;
  const bool holds = held || large_chunk_holds(head, size);
  file_.seek(records);
  LimitedBytes compressed(file_, size);
  const std::unique_ptr<ByteStream> stream =
      inflated(head.compression == "lz4" ? Compression::kLz4 : Compression::kZstd, compressed);
  BudgetedBytes plain(*stream, head.plain_size, budget_);
  std::string reason;
  try {
    if (!holds) {
      leave_out(plain, begin, size);
      return;
    }
    reason = held ? read_held(head, begin, size, plain) : read_streamed(head, plain);
  } catch (const InflateError& error) {
    reason = error.what();
  }
  if (reason.empty()) return;
  notes_.add(begin, "the chunk is damaged: " + reason);
  // What was in the decompressor's hands when it failed is lost as well.
  const std::uint64_t taken = std::min(file_.position() - records, size);
  facts_.lost_bytes += size - taken + std::min<std::uint64_t>(taken, kSearchWindow);
}

// A chunk that does not inflate is left to the reading, which takes what there is.
bool McapReader::large_chunk_holds(const McapChunkHead& head, std::uint64_t size) {
  if (head.plain_crc == 0 || size < head.records_size) return true;
  LimitedBytes compressed(file_, size);
  const std::unique_ptr<ByteStream> stream =
      inflated(head.compression == "lz4" ? Compression::kLz4 : Compression::kZstd, compressed);
  BudgetedBytes plain(*stream, head.plain_size, budget_);
  try {
    return checksum_holds(plain, head.plain_size, head.plain_crc,
                          [this] { tell_progress(file_.position()); }) ||
           plain.left() > 0;
  } catch (const InflateError&) {
    return true;
  }
}

std::string McapReader::read_held(const McapChunkHead& head, std::uint64_t begin,
                                  std::uint64_t size, BudgetedBytes& plain) {
  const auto declared = static_cast<std::size_t>(head.plain_size);
  if (held_.size() < declared) held_.resize(declared);
  std::size_t got = 0;
  std::string reason;
  try {
    while (const std::size_t more = plain.read(held_.data() + got, declared - got)) got += more;
    if (got < declared) {
      reason =
          "it becomes " + std::to_string(got) + " bytes and declares " + std::to_string(declared);
    } else if (plain.has_more()) {
      reason = "it becomes more than the " + std::to_string(declared) + " bytes that it declares";
    }
  } catch (const InflateError& error) {
    reason = error.what();
  }
  MemoryBytes content({held_.data(), got});
  if (reason.empty() && head.plain_crc != 0) {
    MemoryBytes again({held_.data(), got});
    if (!checksum_holds(again, got, head.plain_crc)) {
      leave_out(content, begin, size);
      return {};
    }
  }
  if (!read_inner(content) && reason.empty()) reason = "a record in it is not whole";
  return reason;
}

std::string McapReader::read_streamed(const McapChunkHead& head, BudgetedBytes& plain) {
  if (!read_inner(plain)) return "a record in it is not whole";
  if (plain.left() == 0 && !plain.has_more()) return {};
  return "it does not become the " + std::to_string(head.plain_size) + " bytes that it declares";
}

// Counts what a chunk has whose checksum differs. Its definitions serve where there are no others.
void McapReader::leave_out(ByteStream& content, std::uint64_t begin, std::uint64_t size) {
  std::uint64_t messages = 0;
  std::set<std::string> topics;
  McapRecord record;
  while (read_mcap_record(content, record)) {
    LimitedBytes part(content, record.length);
    if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) {
      channels_.take(record, part, true);
    }
    std::array<char, 2> id{};
    if (record.op == McapOp::kMessage && part.read_exactly(id.data(), id.size())) {
      budget_.take_message();
      ++messages;
      const auto* channel = channels_.find(FieldBytes({id.data(), 2}, Encoding::kRos1).u16());
      if (channel != nullptr) topics.insert(printable_name(channel->topic.name));
    }
    part.skip(part.left());
    if (part.left() > 0) break;
  }
  std::string names;
  std::size_t named = 0;
  for (const std::string& topic : topics) {
    if (named == kMostTopicsNamed) names += ", ...";
    if (named++ >= kMostTopicsNamed) break;
    names += (names.empty() ? " of " : ", ") + topic;
  }
  notes_.add(begin, "a chunk's checksum differs; its " + counted(messages, "message") + names +
                        " were left out");
  facts_.lost_bytes += size;
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
        const McapChannels::Taken taken = channels_.take(record, content);
        if (taken == McapChannels::Taken::kNonsense) return false;
        if (taken == McapChannels::Taken::kContradiction) {
          notes_.add(channels_.contradiction() + "; its messages from there on are left out");
        }
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
  budget_.take_message();
  McapChannels::Channel* channel = channels_.find(id);
  if (channel == nullptr || channel->contradicted) {
    ++(channel == nullptr ? unknown_ : contradicted_);
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

void McapReader::sum_data(std::uint64_t to) {
  to = std::min(to, summary_.checked_end);
  // Not for a few bytes at a time, but at the end.
  if (!behind_) return;
  if (to < behind_->position() + kSearchWindow && to < summary_.checked_end) return;
  std::vector<char> buffer(kSearchWindow);
  while (behind_->position() < to) {
    const std::size_t size = behind_->read(
        buffer.data(),
        static_cast<std::size_t>(std::min<std::uint64_t>(to - behind_->position(), buffer.size())));
    if (size == 0) return;
    data_sum_.add({buffer.data(), size});
    tell_progress(behind_->position());
  }
}

void McapReader::conclude() {
  const McapSummary& summary = summary_;
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
  if (contradicted_ > 0) {
    notes_.add(counted(contradicted_, "message") +
               " of channels that stand for two topics were left out");
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
