#include "bags/foxglove.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace simbench::bags {
namespace {

constexpr std::int64_t kMostSeconds = std::int64_t{1} << 33;  // until the year 2242
constexpr std::int64_t kSecondNs = 1'000'000'000;

std::optional<Nanoseconds> stamp_of(std::int64_t seconds, std::int64_t nanoseconds) {
  if (seconds < -kMostSeconds || seconds > kMostSeconds) return std::nullopt;
  if (nanoseconds < 0 || nanoseconds >= kSecondNs) return std::nullopt;
  return std::chrono::seconds(seconds) + Nanoseconds(nanoseconds);
}

// Fields of a message of protobuf, as far as its bytes reach.
class ProtobufFields {
 public:
  explicit ProtobufFields(std::string_view bytes) : bytes_(bytes) {}

  // False at the end, and for bytes that make no sense.
  bool next() {
    const std::optional<std::uint64_t> tag = varint();
    if (!tag) return false;
    field_ = *tag >> 3;
    bytes_of_field_ = {};
    switch (*tag & 7) {
      case 0: {
        const std::optional<std::uint64_t> read = varint();
        number_ = read.value_or(0);
        return read.has_value();
      }
      case 1:
        return take(8);
      case 2: {
        const std::optional<std::uint64_t> length = varint();
        return length && take(*length);
      }
      case 5:
        return take(4);
      default:
        return false;
    }
  }
  std::uint64_t field() const { return field_; }
  std::int64_t number() const { return static_cast<std::int64_t>(number_); }
  std::string_view bytes() const { return bytes_of_field_; }

 private:
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !bytes_.empty(); shift += 7) {
      const auto byte = static_cast<std::uint8_t>(bytes_.front());
      bytes_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if ((byte & 0x80) == 0) return value;
    }
    return std::nullopt;
  }
  bool take(std::uint64_t length) {
    if (length > bytes_.size()) return false;
    bytes_of_field_ = bytes_.substr(0, static_cast<std::size_t>(length));
    bytes_.remove_prefix(bytes_of_field_.size());
    return true;
  }

  std::string_view bytes_;
  std::string_view bytes_of_field_{};
  std::uint64_t field_ = 0;
  std::uint64_t number_ = 0;
};

std::optional<Nanoseconds> protobuf_stamp(std::string_view head) {
  ProtobufFields message(head);
  while (message.next()) {
    if (message.field() != 1) continue;
    // What is 0 is not written.
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    ProtobufFields stamp(message.bytes());
    while (stamp.next()) {
      if (stamp.field() == 1) seconds = stamp.number();
      if (stamp.field() == 2) nanoseconds = stamp.number();
    }
    return stamp_of(seconds, nanoseconds);
  }
  return std::nullopt;
}

// Reads on until the stamp is there: the end of the text may be missing.
class JsonStamp final : public nlohmann::json_sax<nlohmann::json> {
 public:
  std::optional<Nanoseconds> stamp() const {
    return seconds_ && nanoseconds_ ? stamp_of(*seconds_, *nanoseconds_) : std::nullopt;
  }

  bool key(string_t& name) override {
    if (depth_ == 1) in_stamp_ = name == "timestamp";
    wanted_ = !in_stamp_ || depth_ != 2 ? nullptr
              : name == "sec"           ? &seconds_
              : name == "nsec"          ? &nanoseconds_
                                        : nullptr;
    return true;
  }
  bool number_integer(number_integer_t value) override { return take(value); }
  bool number_unsigned(number_unsigned_t value) override {
    return take(static_cast<std::int64_t>(std::min<number_unsigned_t>(value, 1ULL << 62)));
  }
  bool start_object(std::size_t) override { return nested(1); }
  bool end_object() override { return nested(-1); }
  bool start_array(std::size_t) override { return nested(1); }
  bool end_array() override { return nested(-1); }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  bool nested(int change) {
    depth_ += change;
    return true;
  }
  bool take(std::int64_t value) {
    if (wanted_ != nullptr) *wanted_ = value;
    wanted_ = nullptr;
    return !(seconds_ && nanoseconds_);
  }

  int depth_ = 0;
  bool in_stamp_ = false;
  std::optional<std::int64_t>* wanted_ = nullptr;
  std::optional<std::int64_t> seconds_{};
  std::optional<std::int64_t> nanoseconds_{};
};

}  // namespace

std::optional<Nanoseconds> foxglove_stamp(std::string_view head, Encoding encoding) {
  if (encoding == Encoding::kProtobuf) return protobuf_stamp(head);
  JsonStamp reader;
  nlohmann::json::sax_parse(head, &reader);
  return reader.stamp();
}

}  // namespace simbench::bags
