#include "bags/fields.h"

namespace simbench::bags {
namespace {

constexpr std::size_t kEncapsulation = 4;

}  // namespace

FieldBytes::FieldBytes(std::string_view bytes, Encoding encoding)
    : bytes_(bytes), cdr_(encoding == Encoding::kCdr) {
  if (!cdr_) return;
  // Its second byte: 0 big-endian, 1 little-endian; alignment counts from its end.
  ok_ = bytes.size() >= kEncapsulation;
  if (!ok_) return;
  big_endian_ = bytes[1] == 0;
  bytes_.remove_prefix(kEncapsulation);
}

std::uint64_t FieldBytes::number(std::size_t size) {
  if (cdr_) at_ = (at_ + size - 1) / size * size;
  if (!ok_ || at_ > bytes_.size() || bytes_.size() - at_ < size) {
    ok_ = false;
    return 0;
  }
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = big_endian_ ? i : size - 1 - i;
    value = value << 8 | static_cast<std::uint8_t>(bytes_[at_ + place]);
  }
  at_ += size;
  return value;
}

std::string_view FieldBytes::text() {
  const std::size_t length = u32();
  if (!ok_) return {};
  std::string_view found = bytes_.substr(at_, length);
  ok_ = found.size() == length;
  at_ += found.size();
  // CDR counts the zero at the end.
  if (cdr_ && found.ends_with('\0')) found.remove_suffix(1);
  return found;
}

MessageHeader read_header(FieldBytes& fields) {
  MessageHeader header;
  if (!fields.is_cdr()) header.sequence = fields.u32();
  const std::uint32_t seconds = fields.u32();
  const std::uint32_t nanoseconds = fields.u32();
  // Seconds are signed in ROS 2 and unsigned in ROS 1.
  const std::int64_t whole = fields.is_cdr()
                                 ? static_cast<std::int64_t>(static_cast<std::int32_t>(seconds))
                                 : static_cast<std::int64_t>(seconds);
  header.stamp = std::chrono::seconds(whole) + Nanoseconds(nanoseconds);
  header.frame = fields.text();
  return header;
}

std::string ros1_type(std::string name) {
  const std::size_t at = name.find("/msg/");
  if (at != std::string::npos) name.erase(at, 4);
  return name;
}

}  // namespace simbench::bags
