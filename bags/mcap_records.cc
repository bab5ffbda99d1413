#include "bags/mcap_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bags/checksum.h"
#include "bags/fields.h"
#include "bags/message_types.h"
#include "recording/text_fields.h"

namespace simbench::bags {
namespace {

constexpr std::uint64_t kFooterSize = 20;
constexpr std::size_t kChunkFixed = 8 + 8 + 8 + 4 + 4 + 8;  // all but the compression's name
constexpr std::size_t kMostCompressionName = 64;
constexpr std::size_t kMostRecordRead = std::size_t{64} << 10;
constexpr std::size_t kMostNames = std::size_t{32} << 20;
// The first field of a message stands behind few comments.
constexpr std::size_t kMostDefinition = std::size_t{8} << 10;
constexpr std::string_view kLastMagic = "\x89MCAP0\r\n";

Encoding encoding_of(std::string_view name) {
  if (name == "cdr") return Encoding::kCdr;
  if (name == "ros1") return Encoding::kRos1;
  if (name == "protobuf") return Encoding::kProtobuf;
  return name == "json" ? Encoding::kJson : Encoding::kOther;
}

// Reads as much of a record's content as its names can be in.
std::string record_start(ByteStream& content, std::uint64_t length) {
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(length, kMostRecordRead)),
                    '\0');
  bytes.resize(content.read_up_to(bytes.data(), bytes.size()));
  return bytes;
}

// What a writer that knows the publisher says of it.
std::string publisher_in(std::string_view metadata) {
  FieldBytes pairs(metadata, Encoding::kRos1);
  std::size_t used = 0;
  while (used < metadata.size()) {
    const std::string_view key = pairs.text();
    const std::string_view value = pairs.text();
    if (!pairs.ok()) break;
    if (key == "callerid") return std::string(value);
    used += 8 + key.size() + value.size();
  }
  return {};
}

// The checksum of all before the record DataEnd, where that stands before the summary.
void read_data_end(FileBytes& file, std::uint64_t next, McapSummary& summary) {
  constexpr std::uint64_t kSize = kMcapRecordHead + 4;
  if (next < kMcapMagicSize + kSize || next > file.size()) return;
  std::array<char, kSize> bytes{};
  file.seek(next - kSize);
  if (!file.read_exactly(bytes.data(), bytes.size())) return;
  FieldBytes fields({bytes.data(), bytes.size()}, Encoding::kRos1);
  if (fields.u8() != static_cast<std::uint8_t>(McapOp::kDataEnd) || fields.u64() != 4) return;
  summary.data_crc = fields.u32();
  if (summary.data_crc != 0) summary.checked_end = next - kSize;
}

}  // namespace

bool checksum_holds(ByteStream& bytes, std::uint64_t count, std::uint32_t expected,
                    const std::function<void()>& on_step) {
  Checksum sum;
  std::vector<char> buffer(std::size_t{64} << 10);
  while (count > 0) {
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(count, buffer.size()));
    const std::size_t size = bytes.read(buffer.data(), most);
    if (size == 0) return false;
    sum.add({buffer.data(), size});
    if (on_step) on_step();
    count -= size;
  }
  return sum.value() == expected;
}

bool read_mcap_record(ByteStream& from, McapRecord& record, bool* ended) {
  std::array<char, kMcapRecordHead> head{};
  const std::size_t size = from.read_up_to(head.data(), head.size());
  if (ended != nullptr) *ended = size == 0;
  if (size < head.size()) return false;
  FieldBytes fields({head.data(), size}, Encoding::kRos1);
  record.op = static_cast<McapOp>(fields.u8());
  record.length = fields.u64();
  return true;
}

std::optional<McapChunkHead> read_mcap_chunk_head(FileBytes& file, std::uint64_t length) {
  if (length < kChunkFixed) return std::nullopt;
  std::array<char, kChunkFixed + kMostCompressionName> bytes{};
  const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(length, bytes.size()));
  if (!file.read_exactly(bytes.data(), most)) {
    // A file that is cut right behind the head still has all of it, if the name is short.
    if (file.position() < file.size()) return std::nullopt;
  }
  FieldBytes fields({bytes.data(), most}, Encoding::kRos1);
  fields.u64();
  fields.u64();
  McapChunkHead head;
  head.plain_size = fields.u64();
  head.plain_crc = fields.u32();
  const std::string_view name = fields.text();
  head.records_size = fields.u64();
  if (!fields.ok() || name.size() > kMostCompressionName) return std::nullopt;
  head.compression = name;
  head.head_size = kChunkFixed + name.size();
  if (head.records_size != length - head.head_size) return std::nullopt;
  return head;
}

bool McapChannels::has_room(std::size_t size) {
  if (size > kMostNames - text_bytes_) return false;
  text_bytes_ += size;
  return true;
}

McapChannels::Taken McapChannels::take(const McapRecord& record, ByteStream& content, bool weak) {
  const std::string bytes = record_start(content, record.length);
  return record.op == McapOp::kSchema ? take_schema(bytes) : take_channel(bytes, weak);
}

McapChannels::Taken McapChannels::take_schema(std::string_view bytes) {
  FieldBytes fields(bytes, Encoding::kRos1);
  const std::uint16_t id = fields.u16();
  const std::string_view name = fields.text();
  const std::string_view encoding = fields.text();
  if (!fields.ok()) return Taken::kNonsense;
  if (schemas_.contains(id)) return Taken::kYes;
  const bool is_text = encoding == "ros1msg" || encoding == "ros2msg";
  const std::string_view definition =
      is_text ? fields.text().substr(0, kMostDefinition) : std::string_view();
  if (!has_room(name.size() + definition.size())) return Taken::kNonsense;
  schemas_.emplace(id, Schema{ros1_type(std::string(name)), std::string(definition)});
  return Taken::kYes;
}

McapChannels::Taken McapChannels::take_channel(std::string_view bytes, bool weak) {
  FieldBytes fields(bytes, Encoding::kRos1);
  const std::uint16_t id = fields.u16();
  Channel channel;
  channel.schema = fields.u16();
  const std::string_view topic = fields.text();
  const std::string_view encoding = fields.text();
  if (!fields.ok()) return Taken::kNonsense;
  if (const auto known = channels_.find(id); known != channels_.end()) {
    Channel& other = known->second;
    const bool same = other.topic.name == topic && other.topic.encoding == encoding_of(encoding) &&
                      other.schema == channel.schema;
    if (same) other.weak = other.weak && weak;
    if (same || weak || other.contradicted) return Taken::kYes;
    if (!other.weak || other.number != kNoTopic) {
      other.contradicted = true;
      contradiction_ = fmt::format("channel {} stands for {} and for {}", id,
                                   printable_name(other.topic.name), printable_name(topic));
      return Taken::kContradiction;
    }
    channels_.erase(known);
  }
  const std::string publisher = publisher_in(fields.text());
  if (!has_room(topic.size() + publisher.size())) return Taken::kNonsense;
  channel.weak = weak;
  channel.topic = {.name = std::string(topic),
                   .type = {},
                   .publisher = publisher,
                   .encoding = encoding_of(encoding)};
  channels_.emplace(id, std::move(channel));
  return Taken::kYes;
}

McapChannels::Channel* McapChannels::find(std::uint16_t id) {
  const auto found = channels_.find(id);
  return found == channels_.end() ? nullptr : &found->second;
}

void McapChannels::announce(Channel& channel, BagSink& sink) {
  if (channel.number != kNoTopic) return;
  const auto schema = schemas_.find(channel.schema);
  if (schema != schemas_.end()) channel.topic.type = schema->second.name;
  channel.topic.headed = headed_by(
      channel.topic, schema != schemas_.end() ? schema->second.definition : std::string_view());
  channel.number = announced_++;
  channel.wanted = sink.on_topic(channel.number, channel.topic);
  if (channel.wanted != kLeaveOut) channel.wanted = std::min(channel.wanted, kMostHead);
}

void McapChannels::announce_all(BagSink& sink) {
  for (auto& [id, channel] : channels_) announce(channel, sink);
}

McapSummary read_mcap_summary(FileBytes& file, McapChannels& channels) {
  McapSummary summary;
  summary.data_end = file.size();
  constexpr std::uint64_t kEnd = kMcapRecordHead + kFooterSize + kMcapMagicSize;
  if (file.size() < kMcapMagicSize + kEnd) return summary;
  const std::uint64_t footer = file.size() - kEnd;
  std::array<char, kEnd> bytes{};
  file.seek(footer);
  if (!file.read_exactly(bytes.data(), bytes.size())) return summary;
  const std::string_view end(bytes.data(), bytes.size());
  FieldBytes fields(end.substr(0, kMcapRecordHead + kFooterSize), Encoding::kRos1);
  const bool is_footer = fields.u8() == static_cast<std::uint8_t>(McapOp::kFooter) &&
                         fields.u64() == kFooterSize && end.ends_with(kLastMagic);
  if (!is_footer) return summary;
  summary.closed = true;
  summary.data_end = footer;
  const std::uint64_t start = fields.u64();
  fields.u64();
  const std::uint32_t crc = fields.u32();
  read_data_end(file, start == 0 ? footer : start, summary);
  if (start == 0) return summary;
  summary.damaged = start < kMcapMagicSize || start > footer;
  if (!summary.damaged && crc != 0) {
    file.seek(start);
    summary.damaged = !checksum_holds(file, file.size() - kMcapMagicSize - 4 - start, crc);
  }
  if (summary.damaged) return summary;
  file.seek(start);
  McapRecord record;
  while (file.position() < footer && read_mcap_record(file, record)) {
    const std::uint64_t content = file.position();
    if (content > footer || record.length > footer - content) {
      summary.damaged = true;
      break;
    }
    if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) {
      LimitedBytes part(file, record.length);
      channels.take(record, part, true);
    } else if (record.op == McapOp::kStatistics && record.length >= 8) {
      std::array<char, 8> count{};
      if (file.read_exactly(count.data(), count.size())) {
        summary.messages = FieldBytes({count.data(), count.size()}, Encoding::kRos1).u64();
      }
    }
    file.seek(content + record.length);
  }
  return summary;
}

}  // namespace simbench::bags
