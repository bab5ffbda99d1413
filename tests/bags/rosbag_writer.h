// Writes rosbag 2.0, as the recorders of ROS 1 and of the RealSense SDK do, and breaks it where a
// test wants that.
//
//   RosbagWriter writer(RosbagWriter::Chunks::kLz4);
//   const auto topic = writer.add_topic("/cam/image_raw", "sensor_msgs/Image");
//   writer.add_message(topic, seconds(1), ros1_header(1, seconds(1), "cam") + pixels);
//   write_file("rig.bag", writer.bag());
#pragma once

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::bags {

template <class Number>
std::string little_endian(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
  return bytes;
}

inline std::string ros1_text(std::string_view text) {
  return little_endian(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

inline std::string ros1_time(Nanoseconds time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  return little_endian(static_cast<std::uint32_t>(whole.count())) +
         little_endian(static_cast<std::uint32_t>((time - whole).count()));
}

// std_msgs/Header.
inline std::string ros1_header(std::uint32_t sequence, Nanoseconds stamp, std::string_view frame) {
  return little_endian(sequence) + ros1_time(stamp) + ros1_text(frame);
}

// diagnostic_msgs/KeyValue.
inline std::string ros1_key_value(std::string_view key, std::string_view value) {
  return ros1_text(key) + ros1_text(value);
}

inline void write_bytes(const std::string& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

class RosbagWriter {
 public:
  enum class Chunks : std::uint8_t { kNone, kLz4, kBzip2 };

  explicit RosbagWriter(Chunks chunks, std::size_t chunk_bytes = std::size_t{64} << 10)
      : chunks_(chunks), chunk_bytes_(chunk_bytes) {}

  std::uint32_t add_topic(const std::string& name, const std::string& type,
                          const std::string& publisher = "/recorder",
                          const std::string& definition = "Header header\n") {
    const auto number = static_cast<std::uint32_t>(connections_.size());
    const std::string header =
        field("conn", little_endian(number)) + field("op", "\x07") + field("topic", name);
    const std::string data = field("topic", name) + field("type", type) +
                             field("md5sum", std::string(32, '0')) +
                             field("message_definition", definition) + field("callerid", publisher);
    connections_.push_back(record(header, data));
    return number;
  }

  void add_message(std::uint32_t topic, Nanoseconds log_time, std::string_view bytes) {
    if (!begun_.contains(topic)) chunk_ += connections_[topic];
    begun_[topic] = true;
    entries_[topic] +=
        ros1_time(log_time) + little_endian(static_cast<std::uint32_t>(chunk_.size()));
    begin_ = messages_in_chunk_ == 0 ? log_time : std::min(begin_, log_time);
    end_ = messages_in_chunk_++ == 0 ? log_time : std::max(end_, log_time);
    ++messages_;
    chunk_ += record(field("conn", little_endian(topic)) + field("op", "\x02") +
                         field("time", ros1_time(log_time)),
                     bytes);
    if (chunk_.size() >= chunk_bytes_) end_chunk();
  }

  std::uint64_t messages() const { return messages_; }
  // Where the chunks written so far begin.
  const std::vector<std::uint64_t>& chunk_positions() const { return positions_; }

  // The bag with its index; without: as of a recorder that was killed.
  std::string bag(bool indexed = true, const std::string& encryptor = "") {
    end_chunk();
    const std::uint64_t index_at = kFirstChunk + body_.size();
    std::string header =
        field("index_pos", little_endian(indexed ? index_at : 0)) +
        field("conn_count",
              little_endian(static_cast<std::uint32_t>(indexed ? connections_.size() : 0))) +
        field("chunk_count",
              little_endian(static_cast<std::uint32_t>(indexed ? positions_.size() : 0))) +
        field("op", "\x03");
    if (!encryptor.empty()) header += field("encryptor", encryptor);
    const std::string padding(kFirstChunk - kMagic.size() - 8 - header.size(), ' ');
    std::string bag = std::string(kMagic) + record(header, padding) + body_;
    if (!indexed) return bag;
    for (const std::string& connection : connections_) bag += connection;
    return bag + infos_;
  }

  static std::string field(std::string_view name, std::string_view value) {
    return ros1_text(std::string(name) + "=" + std::string(value));
  }
  static std::string record(std::string_view header, std::string_view data) {
    return ros1_text(header) + ros1_text(data);
  }

 private:
  static constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
  static constexpr std::size_t kFirstChunk = 4096 + 13;
  static constexpr std::size_t kEntry = 12;  // of the index: a time, an offset

  void end_chunk() {
    if (chunk_.empty()) return;
    const std::uint64_t position = kFirstChunk + body_.size();
    positions_.push_back(position);
    body_ += record(field("compression", name()) + field("op", "\x05") +
                        field("size", little_endian(static_cast<std::uint32_t>(chunk_.size()))),
                    packed());
    std::string counts;
    for (const auto& [topic, entries] : entries_) {
      const auto count = static_cast<std::uint32_t>(entries.size() / kEntry);
      counts += little_endian(topic) + little_endian(count);
      body_ += record(field("conn", little_endian(topic)) + field("count", little_endian(count)) +
                          field("op", "\x04") + field("ver", little_endian(1U)),
                      entries);
    }
    infos_ +=
        record(field("chunk_pos", little_endian(position)) +
                   field("count", little_endian(static_cast<std::uint32_t>(entries_.size()))) +
                   field("end_time", ros1_time(end_)) + field("op", "\x06") +
                   field("start_time", ros1_time(begin_)) + field("ver", little_endian(1U)),
               counts);
    messages_in_chunk_ = 0;
    chunk_.clear();
    entries_.clear();
  }

  const char* name() const {
    return chunks_ == Chunks::kLz4 ? "lz4" : chunks_ == Chunks::kBzip2 ? "bz2" : "none";
  }

  std::string packed() const {
    if (chunks_ == Chunks::kNone) return chunk_;
    std::string bytes(LZ4F_compressFrameBound(chunk_.size(), nullptr) + chunk_.size() + 1024, '\0');
    if (chunks_ == Chunks::kLz4) {
      // With a checksum, as both recorders have it.
      LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
      preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
      bytes.resize(LZ4F_compressFrame(bytes.data(), bytes.size(), chunk_.data(), chunk_.size(),
                                      &preferences));
      return bytes;
    }
    auto size = static_cast<unsigned>(bytes.size());
    std::string plain = chunk_;
    if (BZ2_bzBuffToBuffCompress(bytes.data(), &size, plain.data(),
                                 static_cast<unsigned>(plain.size()), 9, 0, 0) != BZ_OK) {
      throw std::runtime_error("bzip2 does not compress");
    }
    bytes.resize(size);
    return bytes;
  }

  Chunks chunks_;
  std::size_t chunk_bytes_;
  std::vector<std::string> connections_;
  std::map<std::uint32_t, bool> begun_;
  std::map<std::uint32_t, std::string> entries_;  // of the chunk, by topic
  Nanoseconds begin_{};
  Nanoseconds end_{};
  std::uint64_t messages_in_chunk_ = 0;
  std::vector<std::uint64_t> positions_;
  std::string chunk_;
  std::string body_;
  std::string infos_;
  std::uint64_t messages_ = 0;
};

}  // namespace simbench::bags
