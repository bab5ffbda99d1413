#include "reports/sweep/sweep_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "algorithms/ports/assert.h"
#include "reports/text/output_folder.h"

namespace simbench::reports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void log_failed(const fs::path& path, const std::string& what) {
  throw OutputError(
      fmt::format("{}: {}: {}; every run finished by now is kept, and the same "
                  "command goes on from there",
                  path.string(), what, std::strerror(errno)));
}

// Writes all of it or says so; errno tells why not.
bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

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
  std::size_t run = 0;
  const auto [stop, error] = std::from_chars(line.data(), line.data() + first, run);
  if (error != std::errc() || run >= texts_.size()) return false;
  const std::string_view text = line.substr(second + 1);
  // Made again, so that a line counts only in the one way in which it is written.
  if (text.empty() || this->line(run, text) != fmt::format("{}\n", line)) return false;
  if (texts_[run].empty()) ++finished_;
  texts_[run] = text;
  return true;
}

void SweepLog::read() {
  std::error_code error;
  if (!fs::exists(path_, error)) return;
  std::ifstream in(path_, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  if (!in) log_failed(path_, "cannot be read");
  std::string_view rest = content;
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
    // Half a line would only be damage to report later; if this fails too, it is reported.
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

}  // namespace simbench::reports
