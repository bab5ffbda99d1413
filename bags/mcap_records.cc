#include "bags/mcap_records.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <vector>

#include "bags/fields.h"
#include "bags/message_types.h"

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

bool checksum_holds(FileBytes& file, std::uint64_t from, std::uint64_t to, std::uint32_t expected) {
  boost::crc_32_type crc;
  std::vector<char> buffer(std::size_t{64} << 10);
  file.seek(from);
  while (from < to) {
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(to - from, buffer.size()));
    const std::size_t size = file.read(buffer.data(), most);
    if (size == 0) return false;
    crc.process_bytes(buffer.data(), size);
    from += size;
  }
  return crc.checksum() == expected;
}

}  // namespace

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
  fields.u32();
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

bool McapChannels::take(const McapRecord& record, ByteStream& content) {
  const std::string bytes = record_start(content, record.length);
  return record.op == McapOp::kSchema ? take_schema(bytes) : take_channel(bytes);
}

bool McapChannels::take_schema(std::string_view bytes) {
  FieldBytes fields(bytes, Encoding::kRos1);
  const std::uint16_t id = fields.u16();
  const std::string_view name = fields.text();
  const std::string_view encoding = fields.text();
  if (!fields.ok()) return false;
  if (schemas_.contains(id)) return true;
  const bool is_text = encoding == "ros1msg" || encoding == "ros2msg";
  const std::string_view definition =
      is_text ? fields.text().substr(0, kMostDefinition) : std::string_view();
  if (!has_room(name.size() + definition.size())) return false;
  schemas_.emplace(id, Schema{ros1_type(std::string(name)), std::string(definition)});
  return true;
}

bool McapChannels::take_channel(std::string_view bytes) {
  FieldBytes fields(bytes, Encoding::kRos1);
  const std::uint16_t id = fields.u16();
  Channel channel;
  channel.schema = fields.u16();
  const std::string_view topic = fields.text();
  const std::string_view encoding = fields.text();
  if (!fields.ok()) return false;
  if (channels_.contains(id)) return true;
  const std::string publisher = publisher_in(fields.text());
  if (!has_room(topic.size() + publisher.size())) return false;
  channel.topic = {.name = std::string(topic),
                   .type = {},
                   .publisher = publisher,
                   .encoding = encoding_of(encoding)};
  channels_.emplace(id, std::move(channel));
  return true;
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
  if (start == 0) return summary;
  if (start < kMcapMagicSize || start > footer ||
      (crc != 0 && !checksum_holds(file, start, file.size() - kMcapMagicSize - 4, crc))) {
    summary.damaged = true;
    return summary;
  }
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
      channels.take(record, part);
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
