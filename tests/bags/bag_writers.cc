#include "tests/bags/bag_writers.h"

#include <boost/crc.hpp>
#include <stdexcept>
#include <utility>

namespace simbench::bags {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";

std::uint32_t crc_of(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace

std::string bytes_of(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}

std::string length_and(std::string_view text) {
  return bytes_of(text.size(), 4) + std::string(text);
}

std::string ros1_header(std::uint32_t sequence, std::uint32_t s, std::uint32_t ns,
                        std::string_view frame) {
  return bytes_of(sequence, 4) + bytes_of(s, 4) + bytes_of(ns, 4) + length_and(frame);
}

std::string cdr_header(std::uint32_t s, std::uint32_t ns, std::string_view frame) {
  const std::string text = std::string(frame) + '\0';
  return std::string("\0\1\0\0", 4) + bytes_of(s, 4) + bytes_of(ns, 4) + length_and(text);
}

std::string mcap_record(std::uint8_t op, std::string_view content) {
  return static_cast<char>(op) + bytes_of(content.size(), 8) + std::string(content);
}

McapWriter::McapWriter(McapOptions options)
    : options_(std::move(options)),
      finished_(std::string(kMagic) + mcap_record(1, length_and("ros2") + length_and("tests"))) {}

std::uint16_t McapWriter::channel(std::string_view topic, std::string_view type,
                                  std::string_view encoding, std::string_view publisher,
                                  std::string_view definition) {
  const std::uint16_t id = ++channels_;
  const std::string schema =
      mcap_record(3, bytes_of(id, 2) + length_and(type) +
                         length_and(definition.empty() ? "" : "ros2msg") + length_and(definition));
  const std::string pairs = publisher.empty() ? "" : length_and("callerid") + length_and(publisher);
  const std::string channel = mcap_record(4, bytes_of(id, 2) + bytes_of(id, 2) + length_and(topic) +
                                                 length_and(encoding) + length_and(pairs));
  definitions_ += schema + channel;
  (options_.chunk_bytes > 0 ? chunk_ : finished_) += schema + channel;
  return id;
}

void McapWriter::record(std::uint8_t op, std::string_view content) {
  (options_.chunk_bytes > 0 ? chunk_ : finished_) += mcap_record(op, content);
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_time_ns, std::string_view data) {
  std::string& to = options_.chunk_bytes > 0 ? chunk_ : finished_;
  to += '\5';
  to += bytes_of(22 + data.size(), 8) + bytes_of(channel, 2) + bytes_of(0, 4) +
        bytes_of(log_time_ns, 8) + bytes_of(log_time_ns, 8);
  to += data;
  ++messages_;
  if (options_.chunk_bytes > 0 && chunk_.size() >= options_.chunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string records = deflated(options_.compression, chunk_);
  const std::uint64_t start = taken_ + finished_.size();
  finished_ +=
      mcap_record(6, bytes_of(0, 8) + bytes_of(1, 8) + bytes_of(chunk_.size(), 8) +
                         bytes_of(options_.checksums ? crc_of(chunk_) : 0, 4) +
                         length_and(options_.compression) + bytes_of(records.size(), 8) + records);
  chunk_indexes_ +=
      mcap_record(8, bytes_of(0, 8) + bytes_of(1, 8) + bytes_of(start, 8) +
                         bytes_of(taken_ + finished_.size() - start, 8) + bytes_of(0, 4) +
                         bytes_of(0, 8) + length_and(options_.compression) +
                         bytes_of(records.size(), 8) + bytes_of(chunk_.size(), 8));
  ++chunks_;
  chunk_.clear();
}

std::string McapWriter::take_finished() {
  taken_ += finished_.size();
  return std::exchange(finished_, {});
}

std::string McapWriter::close() {
  end_chunk();
  finished_ += mcap_record(15, bytes_of(options_.data_checksum ? crc_of(finished_) : 0, 4));
  const std::uint64_t start = taken_ + finished_.size();
  std::string summary;
  if (options_.summary) {
    const std::string statistics =
        bytes_of(messages_, 8) + bytes_of(channels_, 2) + bytes_of(channels_, 4) + bytes_of(0, 4) +
        bytes_of(0, 4) + bytes_of(chunks_, 4) + bytes_of(0, 8) + bytes_of(1, 8) + bytes_of(0, 4);
    summary = definitions_ + mcap_record(11, statistics) + chunk_indexes_;
  }
  summary += static_cast<char>(2) + bytes_of(20, 8) + bytes_of(options_.summary ? start : 0, 8) +
             bytes_of(0, 8);
  const std::uint32_t crc = options_.summary ? crc_of(summary) : 0;
  finished_ += summary + bytes_of(crc, 4) + std::string(kMagic);
  return take_finished();
}

SqliteBagWriter::SqliteBagWriter(const std::string& path, bool indexed, int page_bytes) {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open(path.c_str(), &opened);
  database_.reset(opened);
  if (result != SQLITE_OK) throw std::runtime_error("SQLite cannot write " + path);
  run("PRAGMA page_size=" + std::to_string(page_bytes) +
      "; PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN;"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
      " timestamp INTEGER NOT NULL, data BLOB NOT NULL);");
  if (indexed) run("CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(opened, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", -1,
                     &insert, nullptr);
  insert_.reset(insert);
}

std::int64_t SqliteBagWriter::topic(const std::string& name, const std::string& type,
                                    const std::string& format) {
  run("INSERT INTO topics VALUES(" + std::to_string(++topics_) + ",'" + name + "','" + type +
      "','" + format + "','');");
  return topics_;
}

void SqliteBagWriter::message(std::int64_t topic, std::int64_t timestamp_ns,
                              std::string_view data) {
  sqlite3_bind_int64(insert_.get(), 1, topic);
  sqlite3_bind_int64(insert_.get(), 2, timestamp_ns);
  sqlite3_bind_blob64(insert_.get(), 3, data.data(), data.size(), SQLITE_STATIC);
  if (sqlite3_step(insert_.get()) != SQLITE_DONE) throw std::runtime_error("SQLite: no insert");
  sqlite3_reset(insert_.get());
}

void SqliteBagWriter::run(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error(std::string("SQLite: ") + sqlite3_errmsg(database_.get()));
  }
}

void SqliteBagWriter::close() {
  run("COMMIT;");
  insert_.reset();
  database_.reset();
}

std::size_t KeptBag::on_topic(std::uint32_t number, const BagTopic& topic) {
  if (number != topics.size()) throw std::logic_error("topics do not count from 0");
  topics.push_back(topic);
  return wanted_;
}

void KeptBag::on_message(const BagMessage& message) {
  if (message.topic >= topics.size()) throw std::logic_error("a message before its topic");
  messages.push_back(
      {message.topic, message.log_time.count(), message.size, std::string(message.head)});
}

std::string bag_refusal(const std::string& path) {
  KeptBag bag;
  try {
    read_bag(path, bag);
  } catch (const BagError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace simbench::bags
