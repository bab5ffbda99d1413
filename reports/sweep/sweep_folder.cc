#include "reports/sweep/sweep_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "recording/number_in.h"
#include "reports/text/output_file.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void log_failed(const fs::path& path, const std::string& what) {
  throw OutputError(
      fmt::format("{}: {}: {}; all finished runs are kept, and the same command "
                  "continues with the others",
                  path.string(), what, std::strerror(errno)));
}

// Writes all of the text. On failure errno has the reason.
bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Writes a file completely or not at all: under a temporary name (NAME.tmp), then renamed. Unlike
// write_file() it uses a name that the next start knows as the sweep's own and removes, and its
// errors state that the finished runs are kept.
void replace_file(const fs::path& path, std::string_view content) {
  fs::path temporary = path;
  temporary += ".tmp";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) log_failed(path, "cannot be written");
  const bool written = write_all(file, content);
  const int reason = errno;
  const bool closed = ::close(file) == 0;
  if (!written || !closed) {
    if (!written) errno = reason;
    const int kept = errno;
    ::unlink(temporary.c_str());
    errno = kept;
    log_failed(path, "cannot be written");
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) log_failed(path, "cannot be written");
}

constexpr const char* kLog = "runs.log";
constexpr const char* kLock = "lock";
constexpr std::array<const char*, 9> kSweepFiles = {kManifest,   kLog,         kLock,
                                                    "sweep.csv", "hosts.csv",  "sweep.txt",
                                                    "sweep.svg", "sweep.html", "answer.json"};
constexpr const char* kWayOut =
    "name another folder, repeat that sweep's command, or replace it with --restart";

std::vector<std::string> own_names() {
  std::vector<std::string> names;
  for (const char* name : kSweepFiles) {
    names.emplace_back(name);
    names.push_back(fmt::format("{}.tmp", name));
  }
  return names;
}

std::string shown(const nlohmann::json& flat, const std::string& pointer) {
  constexpr std::size_t kLongest = 60;
  if (!flat.contains(pointer)) return "absent";
  const std::string text =
      flat[pointer].dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

// What follows from another difference: what the scenario rests on, and its summary.
bool is_consequence(const std::string& pointer) {
  return pointer == "/based_on" || pointer.starts_with("/changed") ||
         pointer == "/published_left_out" || pointer == "/scenario/summary";
}

// The first difference of two manifests, and the number of further ones.
std::string difference(const nlohmann::json& there, const nlohmann::json& here) {
  const nlohmann::json flat_there = there.flatten();
  const nlohmann::json flat_here = here.flatten();
  std::vector<std::string> pointers;
  for (const auto& [pointer, value] : flat_here.items()) {
    if (!flat_there.contains(pointer) || flat_there[pointer] != value) pointers.push_back(pointer);
  }
  for (const auto& [pointer, value] : flat_there.items()) {
    if (!flat_here.contains(pointer)) pointers.push_back(pointer);
  }
  if (!std::all_of(pointers.begin(), pointers.end(), is_consequence)) {
    std::erase_if(pointers, is_consequence);
  }
  if (pointers.empty()) return "its manifest.json was edited";
  // Where two versions differ, that says most.
  const bool is_other_version = std::ranges::find(pointers, "/version") != pointers.end();
  const std::string first = is_other_version ? "/version" : pointers.front();
  std::string text = fmt::format("{} is {} there and {} here", first, shown(flat_there, first),
                                 shown(flat_here, first));
  if (pointers.size() > 1) text += fmt::format(", and {} more differ", pointers.size() - 1);
  return text;
}

}  // namespace

SweepLog::SweepLog(fs::path path, std::string_view identity, std::size_t runs)
    : path_(std::move(path)), texts_(runs) {
  boost::crc_32_type crc;
  crc.process_bytes(identity.data(), identity.size());
  identity_ = crc.checksum();
  read();
  if (damaged_ > 0) put_in_order();
  open_at_end();
}

SweepLog::~SweepLog() { close(); }

std::uint32_t SweepLog::checksum(std::string_view run, std::string_view text) const {
  const std::string covered = fmt::format("{:08x} {} {}", identity_, run, text);
  boost::crc_32_type crc;
  crc.process_bytes(covered.data(), covered.size());
  return crc.checksum();
}

std::string SweepLog::line(std::size_t run, std::string_view text) const {
  return fmt::format("{} {:08x} {}\n", run, checksum(std::to_string(run), text), text);
}

bool SweepLog::take(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  if (second == std::string_view::npos) return false;
  const auto run = number_in<std::size_t>(line.substr(0, first));
  if (!run || *run >= texts_.size()) return false;
  const std::string_view text = line.substr(second + 1);
  // Made again, so that a line counts only in exactly its written form.
  if (text.empty() || this->line(*run, text) != fmt::format("{}\n", line)) return false;
  if (texts_[*run].empty()) ++finished_;
  texts_[*run] = text;
  return true;
}

void SweepLog::read() {
  std::error_code error;
  if (!fs::exists(path_, error)) return;
  const std::optional<std::string> content = content_of(path_);
  if (!content) log_failed(path_, "cannot be read");
  std::string_view rest = *content;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    // Without its newline the last line is not whole.
    if (end == std::string_view::npos || !take(rest.substr(0, end))) ++damaged_;
    if (end == std::string_view::npos) return;
    rest.remove_prefix(end + 1);
  }
}

void SweepLog::open_at_end() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) log_failed(path_, "cannot be written");
  size_ = ::lseek(file_, 0, SEEK_END);
  if (size_ < 0) log_failed(path_, "cannot be written");
}

void SweepLog::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

void SweepLog::append(std::size_t run, const std::string& text) {
  SIMBENCH_ASSERT(run < texts_.size() && texts_[run].empty(), "a run finishes once");
  SIMBENCH_ASSERT(!text.empty() && text.find('\n') == std::string::npos, "one line");
  const std::string added = line(run, text);
  if (!write_all(file_, added)) {
    const int reason = errno;
    // Removes half a line; if this fails too, the next start reports it as damaged.
    if (::ftruncate(file_, size_) == 0) ::lseek(file_, size_, SEEK_SET);
    errno = reason;
    log_failed(path_, "cannot be written");
  }
  size_ += static_cast<std::int64_t>(added.size());
  texts_[run] = text;
  ++finished_;
}

void SweepLog::put_in_order() {
  std::string content;
  for (std::size_t run = 0; run < texts_.size(); ++run) {
    if (!texts_[run].empty()) content += line(run, texts_[run]);
  }
  close();
  replace_file(path_, content);
  open_at_end();
}

SweepFolder::SweepFolder(const fs::path& folder, const std::string& manifest, std::size_t runs,
                         bool restart)
    : folder_(folder) {
  std::error_code error;
  if (fs::exists(folder_, error)) {
    if (!fs::is_directory(folder_, error)) fail_output(folder_, "is a file; name a folder");
    check_contents();
  } else if (!fs::create_directories(folder_, error) && error) {
    fail_output(folder_, fmt::format("cannot be made: {}", error.message()));
  }
  lock();
  for (const char* name : kSweepFiles) fs::remove(path(fmt::format("{}.tmp", name)), error);
  if (restart) remove_all();
  if (!fs::exists(path(kManifest), error)) {
    if (fs::exists(path(kLog), error)) {
      fail_output(folder_, fmt::format("holds runs of a sweep but no manifest.json; {}", kWayOut));
    }
    write(kManifest, manifest);
  } else {
    check_manifest(manifest);
  }
  log_ = std::make_unique<SweepLog>(path(kLog), manifest, runs);
}

SweepFolder::~SweepFolder() {
  if (lock_ >= 0) ::close(lock_);
}

void SweepFolder::check_contents() const {
  const std::vector<std::string> own = own_names();
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (std::find(own.begin(), own.end(), name) == own.end()) {
      fail_output(
          folder_,
          fmt::format("holds other files ({}); name a new folder or that of a sweep", name));
    }
  }
  if (error) fail_output(folder_, error.message());
}

void SweepFolder::lock() {
  lock_ = ::open(path(kLock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) fail_output(folder_, fmt::format("cannot be written: {}", std::strerror(errno)));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) {
    fail_output(folder_, "another simbench runs this sweep; wait for it or name another folder");
  }
  // A file system without locks, as on some clusters: continue without.
}

void SweepFolder::check_manifest(const std::string& manifest) const {
  const std::optional<std::string> there = content_of(path(kManifest));
  if (!there) fail_output(folder_, fmt::format("{} cannot be read", kManifest));
  if (*there == manifest) return;
  const nlohmann::json found = nlohmann::json::parse(*there, nullptr, false);
  if (!found.is_object()) {
    fail_output(folder_, fmt::format("its {} is damaged; {}", kManifest, kWayOut));
  }
  check_is_sweep(*there);
  fail_output(folder_, fmt::format("holds another sweep: {}; {}",
                                   difference(found, nlohmann::json::parse(manifest)), kWayOut));
}

// Refuses a result that is not a sweep. A damaged manifest may have been a sweep's.
void SweepFolder::check_is_sweep(const std::string& manifest) const {
  const nlohmann::json found = nlohmann::json::parse(manifest, nullptr, false);
  if (found.is_object() && found.value("kind", nlohmann::json()) != "sweep") {
    fail_output(folder_, "holds a result that is not a sweep; name another folder");
  }
}

void SweepFolder::remove_all() const {
  const std::optional<std::string> there = content_of(path(kManifest));
  if (there) check_is_sweep(*there);
  for (const std::string_view name : kSweepFiles) {
    std::error_code error;
    if (name != kLock) fs::remove(folder_ / name, error);
    if (error) fail_output(folder_, fmt::format("{} cannot be removed: {}", name, error.message()));
  }
}

void SweepFolder::write(const std::string& name, std::string_view content) {
  replace_file(path(name), content);
}

void SweepFolder::remove(const std::string& name) {
  std::error_code ignored;
  fs::remove(path(name), ignored);
}

}  // namespace simbench::reports
