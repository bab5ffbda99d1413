#include "bags/rosbag_records.h"

#include <array>

namespace simbench::bags {

std::uint32_t u32_of(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
  return value;
}

std::uint64_t u64_of(const char* bytes) {
  return std::uint64_t{u32_of(bytes + 4)} << 32 | u32_of(bytes);
}

std::optional<std::string_view> field_of(std::string_view fields, std::string_view name) {
  while (fields.size() >= 4) {
    const std::size_t length = u32_of(fields.data());
    fields.remove_prefix(4);
    if (length > fields.size()) return std::nullopt;
    const std::string_view field = fields.substr(0, length);
    if (field.size() > name.size() && field.starts_with(name) && field[name.size()] == '=') {
      return field.substr(name.size() + 1);
    }
    fields.remove_prefix(length);
  }
  return std::nullopt;
}

std::optional<std::uint32_t> u32_field(std::string_view fields, std::string_view name) {
  const auto value = field_of(fields, name);
  if (!value || value->size() != 4) return std::nullopt;
  return u32_of(value->data());
}

std::optional<std::uint64_t> u64_field(std::string_view fields, std::string_view name) {
  const auto value = field_of(fields, name);
  if (!value || value->size() != 8) return std::nullopt;
  return u64_of(value->data());
}

std::optional<Nanoseconds> time_field(std::string_view fields, std::string_view name) {
  const auto value = field_of(fields, name);
  if (!value || value->size() != 8) return std::nullopt;
  return std::chrono::seconds(u32_of(value->data())) + Nanoseconds(u32_of(value->data() + 4));
}

bool RecordHeader::read(ByteStream& stream) {
  std::array<char, 4> number{};
  const std::size_t first = stream.read(number.data(), 1);
  ended_ = first == 0;
  if (ended_ || !stream.read_exactly(number.data() + 1, 3)) return false;
  const std::size_t length = u32_of(number.data());
  if (length == 0 || length > kMostRecordHeader) return false;
  fields_.resize(length);
  if (!stream.read_exactly(fields_.data(), length)) return false;
  if (!stream.read_exactly(number.data(), 4)) return false;
  data_size_ = u32_of(number.data());
  const auto op = field_of(fields_, "op");
  if (!op || op->size() != 1) return false;
  const auto code = static_cast<std::uint8_t>(op->front());
  if (code < static_cast<std::uint8_t>(RecordKind::kMessage) ||
      code > static_cast<std::uint8_t>(RecordKind::kConnection)) {
    return false;
  }
  kind_ = static_cast<RecordKind>(code);
  return true;
}

}  // namespace simbench::bags
