#include "hardware/node/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "hardware/node/protocol.h"
#include "recording/event_text.h"
#include "recording/text_fields.h"

namespace simbench::hardware {
namespace {

namespace fs = std::filesystem;

// A batch is written early when it is this long.
constexpr std::size_t kLongBatch = 64u << 10;
constexpr std::string_view kNoteKind = "note,";
constexpr std::string_view kFrameKind = "frame,";

std::string journal_path(const std::string& folder, const std::string& session) {
  return fmt::format("{}/{}.csv", folder, session);
}

// Deletes the oldest journals, to leave room for one more.
void delete_old(const std::string& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> journals;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".csv" || !is_session_id(entry.path().stem())) continue;
    const fs::file_time_type written = entry.last_write_time(error);
    if (!error) journals.emplace_back(written, entry.path());
  }
  if (journals.size() < kKeptJournals) return;
  std::sort(journals.begin(), journals.end());
  journals.resize(journals.size() - (kKeptJournals - 1));
  for (const auto& [written, path] : journals) fs::remove(path, error);
}

std::string read_at(const Descriptor& file, const std::string& path, std::uint64_t offset,
                    std::size_t length) {
  std::optional<std::string> text = file.read_at(offset, length);
  if (!text) throw JournalError(fmt::format("{}: {}", path, std::strerror(errno)));
  return std::move(*text);
}

// Where the last whole line ends.
std::uint64_t whole_size(const Descriptor& file, const std::string& path) {
  struct stat status = {};
  if (fstat(file.number(), &status) != 0) {
    throw JournalError(fmt::format("{}: {}", path, std::strerror(errno)));
  }
  auto end = static_cast<std::uint64_t>(status.st_size);
  while (end > 0) {
    const std::uint64_t begin = end > 4096 ? end - 4096 : 0;
    const std::string tail = read_at(file, path, begin, static_cast<std::size_t>(end - begin));
    const std::size_t newline = tail.rfind('\n');
    if (newline != std::string::npos) return begin + newline + 1;
    end = begin;
  }
  return 0;
}

}  // namespace

void make_journal_folder(const std::string& folder) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error) throw JournalError(fmt::format("{}: cannot be made: {}", folder, error.message()));
  if (made) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) throw JournalError(fmt::format("{}: {}", folder, error.message()));
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw JournalError(
        fmt::format("{}: no journal can be made there: {}", folder, std::strerror(errno)));
  }
}

Journal::Journal(boost::asio::io_context& context, const std::string& folder,
                 const std::string& session, Trouble trouble)
    : path_(journal_path(folder, session)), trouble_(std::move(trouble)), timer_(context) {
  make_journal_folder(folder);
  delete_old(folder);
  file_.reset(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file_.good()) {
    throw JournalError(fmt::format("{}: cannot be made: {}", path_, std::strerror(errno)));
  }
}

Journal::~Journal() { close(); }

void Journal::write(const KeptEvent& event) {
  if (std::holds_alternative<FrameEvent>(event)) {
    ++frames_;
    if (failed_) ++frames_not_kept_;
  }
  if (failed_ || !file_.good()) return;
  append_event(batch_, event);
  end_line();
}

void Journal::note(const std::string& text) {
  using nlohmann::json;
  const std::string clean = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  if (failed_ || !file_.good()) return;
  batch_ += note_line(json::parse(clean).get<std::string>());
  end_line();
}

void Journal::end_line() {
  batch_ += '\n';
  if (batch_.size() >= kLongBatch) {
    flush();
    return;
  }
  if (armed_) return;
  armed_ = true;
  timer_.expires_after(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(kJournalBatch));
  timer_.async_wait([this, alive = std::weak_ptr(alive_)](const boost::system::error_code& error) {
    if (!error && !alive.expired()) flush();
  });
}

void Journal::flush() {
  if (std::exchange(armed_, false)) timer_.cancel();
  const std::string batch = std::exchange(batch_, {});
  if (batch.empty() || failed_ || !file_.good()) return;
  const std::size_t done = file_.write_all(batch);
  if (done < batch.size()) {
    const int error = errno;
    const std::string_view written(batch.data(), done);
    fail(error, written.rfind('\n') + 1, batch);
    return;
  }
  size_ += batch.size();
}

// `kept` bytes of the batch that could not be written are whole lines on disk.
void Journal::fail(int error, std::size_t kept, std::string_view batch) {
  failed_ = true;
  for (batch.remove_prefix(kept); !batch.empty(); batch.remove_prefix(batch.find('\n') + 1)) {
    if (batch.starts_with(kFrameKind)) ++frames_not_kept_;
  }
  // If this fails too, read_journal() leaves the half line out.
  if (ftruncate(file_.number(), static_cast<off_t>(size_ + kept)) != 0) errno = 0;
  if (trouble_) {
    trouble_(fmt::format("journal {}: {}; from here on frames are counted, not kept", path_,
                         std::strerror(error)));
  }
}

void Journal::close() {
  if (!file_.good()) return;
  flush();
  file_.reset();
}

std::optional<JournalChunk> read_journal(const std::string& folder, const std::string& session,
                                         std::uint64_t offset) {
  const std::string path = journal_path(folder, session);
  if (!is_session_id(session)) return std::nullopt;
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.good() && errno == ENOENT) return std::nullopt;
  if (!file.good()) throw JournalError(fmt::format("{}: {}", path, std::strerror(errno)));
  JournalChunk chunk;
  chunk.size = whole_size(file, path);
  if (offset > chunk.size) {
    throw JournalError(
        fmt::format("offset: found {}, allowed: up to {}, the journal's end", offset, chunk.size));
  }
  const auto length = std::min<std::uint64_t>(chunk.size - offset, kJournalChunkBytes);
  chunk.text = read_at(file, path, offset, static_cast<std::size_t>(length));
  chunk.text.resize(chunk.text.rfind('\n') + 1);  // npos + 1 is 0
  return chunk;
}

std::string note_line(std::string_view text) {
  std::string line(kNoteKind);
  append_escaped(line, text);
  return line;
}

std::optional<std::string> note_of_line(std::string_view line) {
  if (!line.starts_with(kNoteKind)) return std::nullopt;
  FieldReader fields(line);
  fields.next("kind");
  try {
    return fields.text("text");
  } catch (const TextFieldError&) {
    return std::nullopt;
  }
}

}  // namespace simbench::hardware
