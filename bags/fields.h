// Numbers and texts of a message as it is serialised: those of ROS 1 (little-endian, unaligned) and
// of CDR (rosbag2: either byte order, aligned).
//
// A field beyond the end is 0 or empty, and ok() is false from then on: a caller reads what it
// needs and asks once.
//
//   FieldBytes fields(message.head, Encoding::kCdr);
//   const MessageHeader header = read_header(fields);
//   if (!fields.ok()) ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "algorithms/ports/time.h"
#include "bags/bag.h"

namespace simbench::bags {

class FieldBytes {
 public:
  // `bytes` outlive this. CDR: the encapsulation's four bytes included.
  FieldBytes(std::string_view bytes, Encoding encoding);

  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  // A text whose end is missing is what there is of it, and not ok().
  std::string_view text();
  bool ok() const { return ok_; }
  bool is_cdr() const { return cdr_; }

 private:
  std::uint64_t number(std::size_t size);

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool cdr_ = false;
  bool big_endian_ = false;
  bool ok_ = true;
};

// std_msgs/Header.
struct MessageHeader {
  std::optional<std::uint32_t> sequence{};  // ROS 1 alone
  Nanoseconds stamp{};
  std::string_view frame{};
};
MessageHeader read_header(FieldBytes& fields);

// "sensor_msgs/msg/Image" is ROS 2's name of "sensor_msgs/Image".
std::string ros1_type(std::string name);

}  // namespace simbench::bags
