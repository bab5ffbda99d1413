#include "hardware/net/secret_key.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hardware/descriptor.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

constexpr std::size_t kDigits = 2 * SecretKey::kBytes;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw KeyError(fmt::format("{}: {}", path, what));
}

void check_owner_and_rights(const std::string& path, int file) {
  struct stat found {};
  if (fstat(file, &found) != 0) refuse(path, std::strerror(errno));
  if (!S_ISREG(found.st_mode)) {
    refuse(path, "found something that is no regular file, allowed: a file from simbench keygen");
  }
  if (found.st_uid != geteuid() && found.st_uid != 0) {
    refuse(path, fmt::format("found a key that belongs to user {}, allowed: your own or root's; "
                             "mend it with: chown {} '{}'",
                             found.st_uid, geteuid(), path));
  }
  if ((found.st_mode & 077) != 0) {
    refuse(path, fmt::format("found mode {:04o}, allowed: no rights for group or others; "
                             "mend it with: chmod 600 '{}'",
                             found.st_mode & 07777u, path));
  }
}

}  // namespace

SecretKey SecretKey::from_file(const std::string& path) {
  start_sodium();
  // Without blocking: a pipe is refused at once.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.good()) {
    refuse(path, errno == ENOENT ? fmt::format("found no such file; make one with: "
                                               "simbench keygen '{}', and copy it to every host",
                                               path)
                                 : std::string(std::strerror(errno)));
  }
  check_owner_and_rights(path, file.number());
  // One byte more than a key file has, so that a longer file is detected.
  std::optional<std::string> content = file.read_at(0, kDigits + 2);
  if (!content) refuse(path, std::strerror(errno));
  std::string& text = *content;
  SecretKey key;
  std::size_t bytes = 0;
  const bool digits =
      text.size() >= kDigits && sodium_hex2bin(key.bytes_.data(), key.bytes_.size(), text.data(),
                                               kDigits, nullptr, &bytes, nullptr) == 0;
  const bool ends = text.size() == kDigits || (text.size() == kDigits + 1 && text.back() == '\n');
  sodium_memzero(text.data(), text.size());
  if (!digits || bytes != kBytes || !ends) {
    refuse(path, fmt::format("found something that is no key, allowed: {} hexadecimal digits, "
                             "as simbench keygen writes them",
                             kDigits));
  }
  key.secret_ = true;
  return key;
}

void SecretKey::create_file(const std::string& path) {
  start_sodium();
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file.good()) {
    refuse(path, errno == EEXIST ? "found a file there already, and a key is not overwritten; "
                                   "name another, or remove it first"
                                 : std::strerror(errno));
  }
  std::array<unsigned char, kBytes> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  std::string text(kDigits + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
  text.back() = '\n';
  if (file.write_all(text) < text.size() || fsync(file.number()) != 0) {
    const int error = errno;
    unlink(path.c_str());
    refuse(path, std::strerror(error));
  }
  sodium_memzero(bytes.data(), bytes.size());
  sodium_memzero(text.data(), text.size());
}

}  // namespace simbench::hardware
