// Reading and writing by descriptors of any kind.
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "shim/card.h"
#include "shim/chance.h"
#include "shim/link.h"
#include "shim/local.h"
#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {

SIMBENCH_CALL ssize_t read(int fd, void* data, std::size_t size) {
  switch (kind_of(fd)) {
    case Kind::kSocket:
    case Kind::kStream:
      return recv(fd, data, size, 0);
    case Kind::kChance:
      return take_chance(data, size);
    case Kind::kTimer:
      return read_timer(fd, data, size);
    case Kind::kEpoll:
    case Kind::kPulses:
      return refuse(EINVAL);
    case Kind::kCard:
      return read_card(fd, data, size);
    case Kind::kLocal:
      return local_read(fd, data, size);
    default:
      break;
  }
  return machine_call(SYS_read, fd, data, size);
}

SIMBENCH_CALL ssize_t read_checked(int fd, void* data, std::size_t size,
                                   std::size_t room) __asm__("__read_chk");
ssize_t read_checked(int fd, void* data, std::size_t size, std::size_t room) {
  if (room < size) give_up("read() beyond its array");
  return read(fd, data, size);
}

SIMBENCH_CALL ssize_t write(int fd, const void* data, std::size_t size) {
  if (is_socket(fd) || is_stream(fd)) return send(fd, data, size, 0);
  if (is_local(fd)) return local_write(fd, data, size);
  const Kind kind = kind_of(fd);
  const bool is_read_only =
      kind == Kind::kTimer || kind == Kind::kEpoll || kind == Kind::kCard || kind == Kind::kPulses;
  if (is_read_only) return refuse(EINVAL);
  return machine_call(SYS_write, fd, data, size);
}

namespace {

msghdr message_of(const iovec* pieces, int count) {
  msghdr message{};
  message.msg_iov = const_cast<iovec*>(pieces);
  message.msg_iovlen = static_cast<std::size_t>(count);
  return message;
}

bool has_messages(int fd) { return is_socket(fd) || is_stream(fd); }

}  // namespace

SIMBENCH_CALL ssize_t readv(int fd, const iovec* pieces, int count) {
  if (has_messages(fd)) {
    msghdr message = message_of(pieces, count);
    return recvmsg(fd, &message, 0);
  }
  if (is_local(fd) && !local_waits_to_read(fd)) return -1;
  return machine_call(SYS_readv, fd, pieces, count);
}

SIMBENCH_CALL ssize_t writev(int fd, const iovec* pieces, int count) {
  if (has_messages(fd)) {
    const msghdr message = message_of(pieces, count);
    return sendmsg(fd, &message, 0);
  }
  if (!is_local(fd)) return machine_call(SYS_writev, fd, pieces, count);
  ssize_t written = 0;
  for (int i = 0; i < count; ++i) {
    const ssize_t part = local_write(fd, pieces[i].iov_base, pieces[i].iov_len);
    if (part < 0) return written > 0 ? written : -1;
    written += part;
    if (static_cast<std::size_t>(part) < pieces[i].iov_len) break;
  }
  return written;
}

// A stream of stdio's by what others of the host read or write goes by these calls too, as libc's
// own would wait for the machine.

namespace {

struct LocalFile {
  FILE* file = nullptr;
  int fd = -1;
};
LocalFile local_files[64];

void* cookie_of(int fd) { return at<void>(fd); }
int fd_of(void* cookie) { return static_cast<int>(reinterpret_cast<std::intptr_t>(cookie)); }

ssize_t read_local(void* cookie, char* data, std::size_t size) {
  return read(fd_of(cookie), data, size);
}
ssize_t write_local(void* cookie, const char* data, std::size_t size) {
  const ssize_t written = write(fd_of(cookie), data, size);
  return written < 0 ? 0 : written;
}
int close_local(void* cookie) {
  for (LocalFile& each : local_files) {
    if (each.fd == fd_of(cookie)) each = {};
  }
  return close(fd_of(cookie));
}

}  // namespace

SIMBENCH_CALL FILE* fdopen(int fd, const char* mode) {
  if (!is_local(fd) && !has_messages(fd)) return SIMBENCH_REAL(fdopen)(fd, mode);
  FILE* file = fopencookie(
      cookie_of(fd), mode,
      {.read = read_local, .write = write_local, .seek = nullptr, .close = close_local});
  for (LocalFile& each : local_files) {
    if (file == nullptr || each.file != nullptr) continue;
    each = {file, fd};
    break;
  }
  return file;
}

SIMBENCH_CALL int fileno(FILE* file) {
  for (const LocalFile& each : local_files) {
    if (each.file == file) return each.fd;
  }
  return SIMBENCH_REAL(fileno)(file);
}

}  // namespace simbench::shim
