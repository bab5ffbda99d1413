// Records of rosbag 2.0: a header of fields NAME=VALUE, then data.
//
// A header or a field that is no such thing makes no record; nothing throws, whatever the bytes
// are. Source: wiki.ros.org/Bags/Format/2.0.
//
//   RecordHeader header;
//   while (header.read(stream)) use(header.op(), header.data_size());
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algorithms/ports/time.h"
#include "recording/byte_stream.h"

namespace simbench::bags {

enum class RecordKind : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

inline constexpr std::size_t kMostRecordHeader = std::size_t{64} << 10;

// The value of a field in a header or in a connection's data; nothing if it is not there.
std::optional<std::string_view> field_of(std::string_view fields, std::string_view name);
std::optional<std::uint32_t> u32_field(std::string_view fields, std::string_view name);
std::optional<std::uint64_t> u64_field(std::string_view fields, std::string_view name);
// Two numbers: seconds and nanoseconds.
std::optional<Nanoseconds> time_field(std::string_view fields, std::string_view name);
// Little-endian; `bytes` has at least that many.
std::uint32_t u32_of(const char* bytes);
std::uint64_t u64_of(const char* bytes);

class RecordHeader {
 public:
  // False at the end of the stream (ended() then) and for what is no record.
  bool read(ByteStream& stream);
  // Whether the stream ended right before the record.
  bool ended() const { return ended_; }

  RecordKind kind() const { return kind_; }
  std::string_view fields() const { return fields_; }
  std::uint32_t data_size() const { return data_size_; }
  // The bytes of the header with its two lengths.
  std::uint64_t size() const { return fields_.size() + 8; }

 private:
  std::string fields_;
  RecordKind kind_ = RecordKind::kMessage;
  std::uint32_t data_size_ = 0;
  bool ended_ = false;
};

}  // namespace simbench::bags
