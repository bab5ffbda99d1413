#include "shim/local.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <initializer_list>

namespace simbench::shim {
namespace {

// What others of the host may have waited for has happened.
template <class Result>
Result told(Result result) {
  if (result >= 0) {
    const int before = errno;
    ask({.call = Call::kLocalActivity});
    errno = before;
  }
  return result;
}

// The path's rest below a folder of run-time files; the path itself if it is elsewhere.
const char* own_path(const char* path) {
  if (!is_simulated() || path == nullptr) return path;
  for (const char* folder : {"/var/run/", "/run/"}) {
    const std::size_t size = strlen(folder);
    if (strncmp(path, folder, size) == 0 && strchr(path + size, '/') == nullptr) {
      return path + size;
    }
  }
  return path;
}

// A Unix-domain address whose path is the program's own.
class OwnName {
 public:
  OwnName(const sockaddr* name, socklen_t size) : name_(name), size_(size) {
    constexpr socklen_t kBegin = offsetof(sockaddr_un, sun_path);
    if (name == nullptr || name->sa_family != AF_UNIX || size <= kBegin) return;
    if (size > sizeof own_) return;
    memcpy(&own_, name, size);
    if (own_.sun_path[0] == '\0') return;
    char path[sizeof own_.sun_path + 1] = {};
    memcpy(path, own_.sun_path, size - kBegin);
    const char* kept = own_path(path);
    if (kept == path) return;
    memset(own_.sun_path, 0, sizeof own_.sun_path);
    memcpy(own_.sun_path, kept, strlen(kept));
    name_ = reinterpret_cast<const sockaddr*>(&own_);
    size_ = static_cast<socklen_t>(kBegin + strlen(kept) + 1);
  }
  const sockaddr* name() const { return name_; }
  socklen_t size() const { return size_; }

 private:
  const sockaddr* name_;
  socklen_t size_;
  sockaddr_un own_{};
};

// Waits in simulated time for what a blocking call would wait for.
void wait_to_read(int fd, int flags) {
  if ((flags & (MSG_DONTWAIT | MSG_ERRQUEUE)) != 0 || !is_blocking(fd)) return;
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  poll(&interest, 1, -1);
}

}  // namespace

int local_socket(int domain, int type, int protocol) {
  const int fd = static_cast<int>(syscall(SYS_socket, domain, type, protocol));
  set_kind(fd, Kind::kLocal);
  return fd;
}

int local_bind(int fd, const sockaddr* name, socklen_t size) {
  const OwnName own(name, size);
  return static_cast<int>(syscall(SYS_bind, fd, own.name(), own.size()));
}

int local_connect(int fd, const sockaddr* name, socklen_t size) {
  const OwnName own(name, size);
  return told(static_cast<int>(syscall(SYS_connect, fd, own.name(), own.size())));
}

ssize_t local_sendmsg(int fd, const msghdr* message, int flags) {
  const OwnName own(static_cast<const sockaddr*>(message->msg_name), message->msg_namelen);
  msghdr sent = *message;
  sent.msg_name = const_cast<sockaddr*>(own.name());
  sent.msg_namelen = own.size();
  return told(static_cast<ssize_t>(syscall(SYS_sendmsg, fd, &sent, flags)));
}

ssize_t local_recvmsg(int fd, msghdr* message, int flags) {
  wait_to_read(fd, flags);
  return static_cast<ssize_t>(syscall(SYS_recvmsg, fd, message, flags));
}

int local_accept(int fd, sockaddr* name, socklen_t* size, int flags) {
  wait_to_read(fd, 0);
  const int accepted = static_cast<int>(syscall(SYS_accept4, fd, name, size, flags));
  set_kind(accepted, Kind::kLocal);
  return accepted;
}

ssize_t local_read(int fd, void* data, std::size_t size) {
  wait_to_read(fd, 0);
  return static_cast<ssize_t>(syscall(SYS_read, fd, data, size));
}

ssize_t local_write(int fd, const void* data, std::size_t size) {
  return told(static_cast<ssize_t>(syscall(SYS_write, fd, data, size)));
}

void local_closed() { told(0); }

SIMBENCH_CALL int socketpair(int domain, int type, int protocol, int ends[2]) {
  if (is_simulated() && domain != AF_UNIX) {
    const bool is_known =
        domain == AF_INET || domain == AF_INET6 || domain == AF_PACKET || domain == AF_NETLINK;
    return refuse(is_known ? EOPNOTSUPP : EAFNOSUPPORT);
  }
  const int result = SIMBENCH_REAL(socketpair)(domain, type, protocol, ends);
  if (result < 0 || !is_simulated()) return result;
  set_kind(ends[0], Kind::kLocal);
  set_kind(ends[1], Kind::kLocal);
  return result;
}

SIMBENCH_CALL int unlink(const char* path) {
  return static_cast<int>(syscall(SYS_unlink, own_path(path)));
}

SIMBENCH_CALL int chmod(const char* path, mode_t mode) {
  return static_cast<int>(syscall(SYS_chmod, own_path(path), mode));
}

}  // namespace simbench::shim
