// rosbag2's SQLite: tables topics and messages.
//
// Messages are read by their ids, which is the order in which they were written; rosbag2 itself
// reads by time of arrival, which is the same order within a topic. Ids follow the file, need no
// index, and reading goes on behind pages that are damaged. Only the head of each message is read
// (sqlite3_blob_read); SQLite does not visit the pages behind it.
//
// Nothing beside the file is changed. What a killed recorder left in a write-ahead log is read
// where it lies: with an exclusive lock SQLite keeps the log's index in memory, the VFS "unix-none"
// takes no lock in truth, and without a checkpoint at the end the log stays. Source:
// sqlite.org/wal.html section 6 (use without shared memory), sqlite.org/uri.html.
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bags/bag.h"
#include "bags/damage_notes.h"
#include "bags/fields.h"
#include "bags/message_types.h"
#include "bags/read_budget.h"
#include "recording/byte_stream.h"
#include "scenarios/input_file.h"

namespace simbench::bags {
namespace {

constexpr int kMostText = 1 << 20;  // of a row of topics or of the schema, bytes
constexpr std::size_t kMostDefinitions = 4096;
constexpr std::uint64_t kMostResumes = 10'000;
constexpr std::uint64_t kProgressMessages = 4096;
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
struct CloseBlob {
  void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;
using Blob = std::unique_ptr<sqlite3_blob, CloseBlob>;

// SQLite opens URIs; what has a meaning in them is written as %XX.
std::string uri_of(const std::string& path, bool with_log) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string uri = "file:";
  for (const char letter : std::filesystem::absolute(path).string()) {
    if (letter == '%' || letter == '?' || letter == '#') {
      const auto code = static_cast<unsigned char>(letter);
      uri += {'%', kDigits[code >> 4], kDigits[code & 15]};
    } else {
      uri += letter;
    }
  }
  return uri + (with_log ? "?mode=ro&vfs=unix-none" : "?mode=ro&immutable=1");
}

// What the header says of the whole: more than there is means that the file is cut off.
std::uint64_t stated_size(const std::string& path) {
  std::array<unsigned char, 32> header{};
  FileBytes file(path);
  if (!file.read_exactly(reinterpret_cast<char*>(header.data()), header.size())) return 0;
  std::uint64_t page = static_cast<std::uint64_t>(header[16]) << 8 | header[17];
  if (page == 1) page = 65536;
  std::uint64_t pages = 0;
  for (std::size_t i = 28; i < 32; ++i) pages = pages << 8 | header.at(i);
  return page * pages;
}

std::string column_text(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
}

// The bytes of one message, as a stream for the decompressor.
class BlobBytes final : public ByteStream {
 public:
  explicit BlobBytes(sqlite3_blob* blob) : blob_(blob), size_(sqlite3_blob_bytes(blob)) {}
  std::size_t read(char* to, std::size_t most) override {
    const int size =
        static_cast<int>(std::min<std::size_t>(most, static_cast<std::size_t>(size_ - at_)));
    if (size == 0) return 0;
    if (sqlite3_blob_read(blob_, to, size, at_) != SQLITE_OK) {
      throw InflateError("zstd: the message's pages are damaged");
    }
    at_ += size;
    return static_cast<std::size_t>(size);
  }
  std::uint64_t skip(std::uint64_t count) override {
    const auto skipped = std::min<std::uint64_t>(count, static_cast<std::uint64_t>(size_ - at_));
    at_ += static_cast<int>(skipped);
    return skipped;
  }

 private:
  sqlite3_blob* blob_;
  int size_;
  int at_ = 0;
};

class SqliteBagReader {
 public:
  SqliteBagReader(const std::string& path, BagSink& sink, const ReadProgress& progress)
      : path_(path),
        sink_(sink),
        progress_(progress),
        notes_(path),
        size_(InputFile(path, Pipes::kRefused).size()),
        budget_(size_) {}

  BagFacts read();

 private:
  struct Topic {
    std::uint32_t number = 0;
    std::size_t wanted = 0;
    bool cdr = false;
  };
  enum class Step : std::uint8_t { kEnd, kDamage };

  void open();
  void open_database();
  std::uint64_t bytes_beside(const char* suffix) const;
  void note_leftovers();
  void expect_tables();
  void read_definitions();
  void read_topics();
  void read_messages();
  // Reads from an id on, and says how that ended; `last_` is the last id that was seen.
  Step read_from(std::int64_t id);
  void read_row(sqlite3_stmt* row);
  bool open_blob(std::int64_t id);
  bool read_head(std::int64_t id, const Topic& topic, std::uint64_t& size, std::size_t& got);
  void inflate_head(std::size_t wanted, std::uint64_t& size, std::size_t& got);
  // The first id behind a damaged place, if any can be read.
  std::optional<std::int64_t> readable_after(std::int64_t damaged);
  std::optional<std::int64_t> first_from(std::int64_t id);
  std::optional<std::int64_t> number_of(const char* query);
  Statement prepare(const std::string& query);
  [[noreturn]] void refuse(const std::string& what) const;
  void conclude();

  const std::string& path_;
  BagSink& sink_;
  const ReadProgress& progress_;
  DamageNotes notes_;
  std::uint64_t size_;
  ReadBudget budget_;
  Database database_{};
  Statement first_{};
  Blob blob_{};
  BagFacts facts_{.format = BagFormat::kSqlite};
  std::map<std::int64_t, Topic> topics_{};
  std::map<std::string, std::string> definitions_{};  // by type
  bool has_definitions_ = false;
  std::string target_{};  // the file itself, where path_ is a link
  bool has_log_ = false;  // a write-ahead log that is read
  std::vector<char> head_{};
  std::int64_t last_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t most_id_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t seen_ = 0;
  bool compressed_ = false;
  bool cut_ = false;
  bool damaged_ = false;
};

void SqliteBagReader::refuse(const std::string& what) const { throw BagError(path_ + ": " + what); }

// Bytes beside the file that it lies in, of which a link may be elsewhere.
std::uint64_t SqliteBagReader::bytes_beside(const char* suffix) const {
  std::error_code none;
  const std::uint64_t size = std::filesystem::file_size(target_ + suffix, none);
  return none ? 0 : size;
}

void SqliteBagReader::open() {
  std::error_code none;
  const std::filesystem::path target = std::filesystem::canonical(path_, none);
  target_ = none ? path_ : target.string();
  has_log_ = bytes_beside("-wal") > 0;
  open_database();
  if (!has_log_) return;
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  const char* first_read = "PRAGMA locking_mode=EXCLUSIVE; SELECT count(*) FROM sqlite_schema;";
  if (sqlite3_exec(database_.get(), first_read, nullptr, nullptr, nullptr) == SQLITE_OK) return;
  has_log_ = false;
  open_database();
}

void SqliteBagReader::open_database() {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open_v2(
      uri_of(path_, has_log_).c_str(), &opened,
      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE,
      nullptr);
  database_.reset(opened);
  if (result != SQLITE_OK) refuse(std::string("SQLite cannot open it: ") + sqlite3_errstr(result));
  const std::uint64_t stated = stated_size(path_);
  cut_ = stated > size_ && !has_log_;
  if (cut_) {
    notes_.add("the file is cut off: its header states " + std::to_string(stated) +
               " bytes, found " + std::to_string(size_));
    facts_.lost_bytes += stated - size_;
  }
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  // SQLite reads a file that is cut off only if its schema could be mended, which `defensive`
  // forbids; nothing is ever written here.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, cut_ ? 0 : 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_WRITABLE_SCHEMA, cut_ ? 1 : 0, nullptr);
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kMostText);
  sqlite3_limit(opened, SQLITE_LIMIT_SQL_LENGTH, kMostText);
  sqlite3_limit(opened, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_exec(opened, "PRAGMA cell_size_check=ON; PRAGMA cache_size=-8192; PRAGMA mmap_size=0;",
               nullptr, nullptr, nullptr);
}

void SqliteBagReader::note_leftovers() {
  for (const std::string suffix : {"-wal", "-journal"}) {
    const std::uint64_t size = bytes_beside(suffix.c_str());
    if (size == 0) continue;
    const std::string what = "its recorder did not close it: what is in " + target_ + suffix +
                             " (" + std::to_string(size) + " bytes) was ";
    notes_.add(what +
               (has_log_ && suffix == "-wal"
                    ? "read too"
                    : "not read; `sqlite3 FILE .tables` on a copy of both files takes it in"));
    facts_.indexed = false;
  }
}

Statement SqliteBagReader::prepare(const std::string& query) {
  sqlite3_stmt* statement = nullptr;
  const int result = sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &statement, nullptr);
  if (result != SQLITE_OK) refuse(std::string("SQLite: ") + sqlite3_errmsg(database_.get()));
  return Statement(statement);
}

void SqliteBagReader::expect_tables() {
  const Statement tables =
      prepare("SELECT substr(name,1,80) FROM sqlite_schema WHERE type='table' AND rootpage>0");
  std::string found;
  int wanted = 0;
  int count = 0;
  int result = 0;
  while ((result = sqlite3_step(tables.get())) == SQLITE_ROW) {
    const std::string name = column_text(tables.get(), 0);
    wanted += name == "topics" || name == "messages" ? 1 : 0;
    has_definitions_ = has_definitions_ || name == "message_definitions";
    if (++count <= 10) found += (count > 1 ? ", " : "") + name;
  }
  if (wanted == 2) return;
  if (result != SQLITE_DONE) refuse(std::string("SQLite: ") + sqlite3_errmsg(database_.get()));
  refuse("found " + (count == 0 ? "no tables" : "the tables " + found) +
         ", allowed: a bag of rosbag2, which has topics and messages");
}

// Recorders since ROS 2 Iron write them.
void SqliteBagReader::read_definitions() {
  if (!has_definitions_) return;
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database_.get(),
                     "SELECT substr(topic_type,1,256), substr(encoded_message_definition,1,8192) "
                     "FROM message_definitions WHERE encoding='ros2msg'",
                     -1, &statement, nullptr);
  const Statement rows(statement);
  // Damaged definitions are none.
  while (rows && sqlite3_step(rows.get()) == SQLITE_ROW && definitions_.size() < kMostDefinitions) {
    definitions_.emplace(ros1_type(column_text(rows.get(), 0)), column_text(rows.get(), 1));
  }
}

void SqliteBagReader::read_topics() {
  const Statement rows = prepare(
      "SELECT id, substr(name,1,4096), substr(type,1,256), substr(serialization_format,1,32) "
      "FROM topics");
  int result = 0;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    if (topics_.size() == kMostTopics) {
      refuse("found more topics than are allowed: " + std::to_string(kMostTopics));
    }
    const std::int64_t id = sqlite3_column_int64(rows.get(), 0);
    if (topics_.contains(id)) continue;
    BagTopic topic;
    topic.name = column_text(rows.get(), 1);
    topic.type = ros1_type(column_text(rows.get(), 2));
    const std::string format = column_text(rows.get(), 3);
    topic.encoding = format == "cdr" ? Encoding::kCdr : Encoding::kOther;
    const auto definition = definitions_.find(topic.type);
    topic.headed = headed_by(
        topic, definition == definitions_.end() ? std::string_view() : definition->second);
    const auto number = static_cast<std::uint32_t>(topics_.size());
    std::size_t needed = sink_.on_topic(number, topic);
    if (needed != kLeaveOut) needed = std::min(needed, kMostHead);
    topics_.emplace(id, Topic{number, needed, topic.encoding == Encoding::kCdr});
  }
  if (result != SQLITE_DONE) {
    damaged_ = true;
    notes_.add(std::string("the table of topics is damaged: ") + sqlite3_errmsg(database_.get()));
  }
}

std::optional<std::int64_t> SqliteBagReader::number_of(const char* query) {
  const Statement statement = prepare(query);
  if (sqlite3_step(statement.get()) != SQLITE_ROW) return std::nullopt;
  if (sqlite3_column_type(statement.get(), 0) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_int64(statement.get(), 0);
}

void SqliteBagReader::read_messages() {
  sqlite3_limit(database_.get(), SQLITE_LIMIT_LENGTH, std::numeric_limits<int>::max());
  first_ = prepare("SELECT rowid FROM messages WHERE rowid>=?1 ORDER BY rowid LIMIT 1");
  most_id_ = number_of("SELECT max(rowid) FROM messages").value_or(0);
  std::int64_t from = std::numeric_limits<std::int64_t>::min();
  for (std::uint64_t resumes = 0; read_from(from) == Step::kDamage; ++resumes) {
    damaged_ = true;
    const std::string reason = sqlite3_errmsg(database_.get());
    const std::int64_t damaged = std::max<std::int64_t>(last_, 0) + 1;
    const std::optional<std::int64_t> next =
        resumes < kMostResumes ? readable_after(damaged) : std::nullopt;
    if (!next) {
      if (most_id_ >= damaged) lost_ += static_cast<std::uint64_t>(most_id_ - damaged) + 1;
      notes_.add("damaged from message " + std::to_string(damaged) + " on: " + reason);
      return;
    }
    lost_ += static_cast<std::uint64_t>(*next - damaged);
    notes_.add("damaged at messages " + std::to_string(damaged) + " to " +
               std::to_string(*next - 1) + ": " + reason);
    from = *next;
    last_ = *next - 1;
  }
}

SqliteBagReader::Step SqliteBagReader::read_from(std::int64_t id) {
  const Statement rows = prepare(
      "SELECT rowid, topic_id, timestamp, length(data), typeof(data) FROM messages "
      "WHERE rowid>=?1 ORDER BY rowid");
  sqlite3_bind_int64(rows.get(), 1, id);
  int result = 0;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    const std::int64_t found = sqlite3_column_int64(rows.get(), 0);
    // Pages that point back would be read for ever.
    if (found <= last_) return Step::kDamage;
    last_ = found;
    if (progress_ && ++seen_ % kProgressMessages == 0 && most_id_ > 0) {
      const double part =
          std::clamp(static_cast<double>(found) / static_cast<double>(most_id_), 0.0, 1.0);
      progress_(static_cast<std::uint64_t>(part * static_cast<double>(size_)), size_);
    }
    read_row(rows.get());
  }
  return result == SQLITE_DONE ? Step::kEnd : Step::kDamage;
}

void SqliteBagReader::read_row(sqlite3_stmt* row) {
  budget_.take_message();
  const auto topic = topics_.find(sqlite3_column_int64(row, 1));
  if (topic == topics_.end()) {
    ++lost_;
    notes_.add("message " + std::to_string(last_) + " is of a topic that is nowhere described");
    return;
  }
  const Topic& of = topic->second;
  auto size = static_cast<std::uint64_t>(std::max<std::int64_t>(sqlite3_column_int64(row, 3), 0));
  std::size_t got = 0;
  if (of.wanted != kLeaveOut && of.wanted > 0 && !read_head(last_, of, size, got)) {
    ++lost_;
    damaged_ = true;
    return;
  }
  ++facts_.messages;
  if (of.wanted == kLeaveOut) return;
  sink_.on_message({.topic = of.number,
                    .log_time = Nanoseconds(sqlite3_column_int64(row, 2)),
                    .size = size,
                    .head = {head_.data(), got}});
}

bool SqliteBagReader::open_blob(std::int64_t id) {
  if (blob_ && sqlite3_blob_reopen(blob_.get(), id) == SQLITE_OK) return true;
  blob_.reset();
  sqlite3_blob* opened = nullptr;
  const int result = sqlite3_blob_open(database_.get(), "main", "messages", "data", id, 0, &opened);
  blob_.reset(opened);
  return result == SQLITE_OK;
}

bool SqliteBagReader::read_head(std::int64_t id, const Topic& topic, std::uint64_t& size,
                                std::size_t& got) {
  if (!open_blob(id)) {
    notes_.add("message " + std::to_string(id) + ": " + sqlite3_errmsg(database_.get()));
    return false;
  }
  const auto bytes = static_cast<std::size_t>(sqlite3_blob_bytes(blob_.get()));
  size = bytes;
  got = std::min(topic.wanted, bytes);
  // The magic of compressed messages is seen even if less is wanted.
  const std::size_t first = std::min(std::max(got, kZstdMagic.size()), bytes);
  if (head_.size() < first) head_.resize(first);
  if (sqlite3_blob_read(blob_.get(), head_.data(), static_cast<int>(first), 0) != SQLITE_OK) {
    notes_.add("message " + std::to_string(id) + ": " + sqlite3_errmsg(database_.get()));
    blob_.reset();
    return false;
  }
  if (!topic.cdr || !std::string_view(head_.data(), first).starts_with(kZstdMagic)) return true;
  try {
    inflate_head(topic.wanted, size, got);
  } catch (const InflateError& error) {
    notes_.add("message " + std::to_string(id) + ": " + error.what());
    return false;
  }
  return true;
}

void SqliteBagReader::inflate_head(std::size_t wanted, std::uint64_t& size, std::size_t& got) {
  compressed_ = true;
  std::array<char, 18> frame{};  // the longest header of a frame
  const int most = std::min(static_cast<int>(frame.size()), sqlite3_blob_bytes(blob_.get()));
  if (sqlite3_blob_read(blob_.get(), frame.data(), most, 0) == SQLITE_OK) {
    const unsigned long long plain =
        ZSTD_getFrameContentSize(frame.data(), static_cast<std::size_t>(most));
    if (plain != ZSTD_CONTENTSIZE_UNKNOWN && plain != ZSTD_CONTENTSIZE_ERROR) size = plain;
  }
  BlobBytes bytes(blob_.get());
  const std::unique_ptr<ByteStream> plain = inflated(Compression::kZstd, bytes);
  if (head_.size() < wanted) head_.resize(wanted);
  got = plain->read_up_to(head_.data(), wanted);
}

std::optional<std::int64_t> SqliteBagReader::first_from(std::int64_t id) {
  sqlite3_reset(first_.get());
  sqlite3_bind_int64(first_.get(), 1, id);
  if (sqlite3_step(first_.get()) != SQLITE_ROW) return std::nullopt;
  const std::int64_t found = sqlite3_column_int64(first_.get(), 0);
  return found >= id ? std::optional(found) : std::nullopt;
}

// Goes on in steps that double, then back by halves: it can miss a page more or less.
std::optional<std::int64_t> SqliteBagReader::readable_after(std::int64_t damaged) {
  std::int64_t bad = damaged - 1;
  std::optional<std::int64_t> good;
  for (std::int64_t step = 1; !good; step *= 2) {
    const std::int64_t at = damaged + step - 1;
    if (at > most_id_ && step > 1) return std::nullopt;
    good = first_from(at);
    if (!good) bad = at;
    if (step > std::numeric_limits<std::int64_t>::max() / 4) return good;
  }
  std::int64_t high = *good;
  while (high - bad > 1) {
    const std::int64_t middle = bad + (high - bad) / 2;
    if (const auto found = first_from(middle)) {
      good = found;
      high = middle;
    } else {
      bad = middle;
    }
  }
  return good;
}

void SqliteBagReader::conclude() {
  facts_.description = compressed_ ? "rosbag2 (SQLite), zstd messages" : "rosbag2 (SQLite)";
  facts_.lost_messages = lost_;
  if (damaged_ || cut_) {
    // The index of the times counts the messages, too, and may be whole where the table is not.
    if (const auto count = number_of("SELECT count(*) FROM messages")) {
      const auto all = static_cast<std::uint64_t>(std::max<std::int64_t>(*count, 0));
      if (all > facts_.messages) facts_.lost_messages = std::max(lost_, all - facts_.messages);
    }
  }
  facts_.notes = notes_.take();
}

BagFacts SqliteBagReader::read() {
  open();
  facts_.indexed = !cut_;
  note_leftovers();
  expect_tables();
  read_definitions();
  read_topics();
  try {
    read_messages();
  } catch (const BudgetSpent& spent) {
    notes_.add(spent.what());
  }
  conclude();
  if (facts_.messages == 0 && topics_.empty() && damaged_) throw BagError(facts_.notes.front());
  return std::move(facts_);
}

}  // namespace

BagFacts read_sqlite_bag(const std::string& path, BagSink& sink, const ReadProgress& progress) {
  return SqliteBagReader(path, sink, progress).read();
}

}  // namespace simbench::bags
