#include "shim/local.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>

#include "shim/children.h"
#include "shim/paths.h"
#include "shim/senders.h"
#include "shim/status.h"
#include "shim/waiting.h"

namespace simbench::shim {
namespace {

// What others of the host may have waited for has happened.
template <class Result>
Result told(Result result) {
  if (result >= 0 && is_watched()) {
    const int before = errno;
    ask({.call = Call::kLocalActivity});
    errno = before;
  }
  return result;
}

constexpr socklen_t kNameBegin = offsetof(sockaddr_un, sun_path);

// A Unix-domain address whose path is the program's own.
class OwnName {
 public:
  OwnName(const sockaddr* name, socklen_t size, Use use) : name_(name), size_(size) {
    if (name == nullptr || name->sa_family != AF_UNIX || size <= kNameBegin) return;
    if (size > sizeof own_) return;
    memcpy(&own_, name, size);
    if (own_.sun_path[0] == '\0') return;
    char path[sizeof own_.sun_path + 1] = {};
    memcpy(path, own_.sun_path, size - kNameBegin);
    const OwnPath kept(path, use);
    const char* text = kept.text();
    if (text == path) return;
    // Names of sockets are short: from the folder itself it is shorter.
    char here[PATH_MAX];
    const bool is_here =
        machine_call(SYS_getcwd, here, sizeof here) > 0 && strcmp(here, own_folder()) == 0;
    if (is_here && strlen(text) > strlen(here) + 1) text += strlen(here) + 1;
    char short_text[PATH_MAX];
    if (strlen(text) >= sizeof own_.sun_path && strlen(text) > strlen(own_folder())) {
      folder_ = static_cast<int>(
          machine_call(SYS_openat, AT_FDCWD, own_folder(), O_PATH | O_DIRECTORY | O_CLOEXEC));
      snprintf(short_text, sizeof short_text, "/proc/self/fd/%d%s", folder_,
               text + strlen(own_folder()));
      text = short_text;
    }
    if (strlen(text) >= sizeof own_.sun_path) return;
    memset(own_.sun_path, 0, sizeof own_.sun_path);
    memcpy(own_.sun_path, text, strlen(text));
    name_ = reinterpret_cast<const sockaddr*>(&own_);
    size_ = static_cast<socklen_t>(kNameBegin + strlen(text) + 1);
  }
  ~OwnName() {
    if (folder_ >= 0) machine_call(SYS_close, folder_);
  }
  OwnName(const OwnName&) = delete;
  OwnName& operator=(const OwnName&) = delete;
  const sockaddr* name() const { return name_; }
  socklen_t size() const { return size_; }

 private:
  const sockaddr* name_;
  socklen_t size_;
  int folder_ = -1;  // open while the call is made: by it, names are short wherever the folder is
  sockaddr_un own_{};
};

// Waits in simulated time for what a blocking call would wait for; false with errno.
bool waits_to_read(int fd, int flags) {
  if ((flags & (MSG_DONTWAIT | MSG_ERRQUEUE)) != 0 || !is_blocking(fd)) return true;
  return wait_for_ready(fd, POLLIN, -1);
}

bool signal_files[kMostDescriptors];  // of signalfd()

bool is_signal_file(int fd) { return fd >= 0 && fd < kMostDescriptors && signal_files[fd]; }

void show_senders(void* data, ssize_t size) {
  auto* infos = static_cast<signalfd_siginfo*>(data);
  for (ssize_t i = 0; i < size / static_cast<ssize_t>(sizeof *infos); ++i) show_sender(infos[i]);
}

// Who is at the other end: the kernel says it by the machine's number.
void show_peer(void* data, std::size_t size) {
  ucred peer{};
  if (!is_simulated() || size < sizeof peer) return;
  memcpy(&peer, data, sizeof peer);
  if (peer.pid > 0) peer.pid = number_of_process(peer.pid);
  peer.uid = 0;
  peer.gid = 0;
  memcpy(data, &peer, sizeof peer);
}

// A descriptor that does not wait meanwhile.
class Unwaiting {
 public:
  explicit Unwaiting(int fd)
      : fd_(fd), flags_(static_cast<int>(machine_call(SYS_fcntl, fd, F_GETFL))) {
    if (is_changed()) machine_call(SYS_fcntl, fd_, F_SETFL, flags_ | O_NONBLOCK);
  }
  ~Unwaiting() {
    const int error = errno;
    if (is_changed()) machine_call(SYS_fcntl, fd_, F_SETFL, flags_);
    errno = error;
  }
  Unwaiting(const Unwaiting&) = delete;
  Unwaiting& operator=(const Unwaiting&) = delete;
  bool is_changed() const { return flags_ >= 0 && (flags_ & O_NONBLOCK) == 0; }

 private:
  int fd_;
  int flags_;
};

// Until there may be room. What says that there is and then has none has another reason, which
// others of the host may take away.
bool waits_to_write(int fd, bool has_failed) {
  return has_failed ? wait_for_activity(true) : wait_for_ready(fd, POLLOUT, -1);
}

// Tries until it need not wait. `Call` is a call that does not wait itself.
template <class Call>
ssize_t write_when_ready(int fd, bool may_wait, Call call) {
  bool has_failed = false;
  for (;;) {
    const ssize_t written = call();
    if (written >= 0 || errno != EAGAIN || !may_wait) return told(written);
    if (!waits_to_write(fd, has_failed)) return -1;
    has_failed = !has_failed;
  }
}

}  // namespace

int local_socket(int domain, int type, int protocol) {
  const int fd = static_cast<int>(machine_call(SYS_socket, domain, type, protocol));
  set_kind(fd, Kind::kLocal);
  return fd;
}

int local_bind(int fd, const sockaddr* name, socklen_t size) {
  const OwnName own(name, size, Use::kCreates);
  const long result = machine_call(SYS_bind, fd, own.name(), own.size());
  if (result == 0 && own.size() > kNameBegin) {
    char path[sizeof(sockaddr_un::sun_path) + 1] = {};  // empty: the name is no path
    memcpy(path, reinterpret_cast<const char*>(own.name()) + kNameBegin, own.size() - kNameBegin);
    if (path[0] != '\0') note_made(AT_FDCWD, path);
  }
  return static_cast<int>(result);
}

int local_connect(int fd, const sockaddr* name, socklen_t size) {
  const OwnName own(name, size, Use::kReads);
  return told(static_cast<int>(machine_call(SYS_connect, fd, own.name(), own.size())));
}

ssize_t local_sendmsg(int fd, const msghdr* message, int flags) {
  const OwnName own(static_cast<const sockaddr*>(message->msg_name), message->msg_namelen,
                    Use::kReads);
  msghdr sent = *message;
  sent.msg_name = const_cast<sockaddr*>(own.name());
  sent.msg_namelen = own.size();
  const bool may_wait = (flags & MSG_DONTWAIT) == 0 && is_blocking(fd);
  return write_when_ready(fd, may_wait, [&] {
    return static_cast<ssize_t>(machine_call(SYS_sendmsg, fd, &sent, flags | MSG_DONTWAIT));
  });
}

ssize_t local_recvmsg(int fd, msghdr* message, int flags) {
  if (!waits_to_read(fd, flags)) return -1;
  const auto got = static_cast<ssize_t>(machine_call(SYS_recvmsg, fd, message, flags));
  for (cmsghdr* each = got < 0 ? nullptr : CMSG_FIRSTHDR(message); each != nullptr;
       each = CMSG_NXTHDR(message, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SCM_CREDENTIALS) continue;
    show_peer(CMSG_DATA(each), each->cmsg_len - CMSG_LEN(0));
  }
  return told(got);
}

int local_getsockopt(int fd, int level, int option, void* value, socklen_t* size) {
  const int result = SIMBENCH_REAL(getsockopt)(fd, level, option, value, size);
  if (result == 0 && level == SOL_SOCKET && option == SO_PEERCRED) show_peer(value, *size);
  return result;
}

int local_accept(int fd, sockaddr* name, socklen_t* size, int flags) {
  if (!waits_to_read(fd, 0)) return -1;
  const int accepted = static_cast<int>(machine_call(SYS_accept4, fd, name, size, flags));
  set_kind(accepted, Kind::kLocal);
  return accepted;
}

ssize_t local_read(int fd, void* data, std::size_t size) {
  if (!waits_to_read(fd, 0)) return -1;
  const auto got = static_cast<ssize_t>(machine_call(SYS_read, fd, data, size));
  if (is_signal_file(fd)) show_senders(data, got);
  // Who writes may have waited for the room.
  return told(got);
}

ssize_t local_write(int fd, const void* data, std::size_t size) {
  const bool may_wait = is_blocking(fd);
  std::size_t written = 0;
  do {
    const ssize_t part = write_when_ready(fd, may_wait, [&] {
      const Unwaiting unwaiting(fd);
      return static_cast<ssize_t>(machine_call(
          SYS_write, fd, static_cast<const unsigned char*>(data) + written, size - written));
    });
    if (part < 0) return written > 0 ? static_cast<ssize_t>(written) : -1;
    written += static_cast<std::size_t>(part);
  } while (may_wait && written < size);
  return static_cast<ssize_t>(written);
}

bool local_waits_to_read(int fd) { return waits_to_read(fd, 0); }

void note_pipe(int fd) {
  struct stat status {};
  if (machine_call(SYS_fstat, fd, &status) == 0 && S_ISFIFO(status.st_mode)) {
    set_kind(fd, Kind::kLocal);
  }
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

namespace {

int keep_local(long fd) {
  if (fd < 0 || !is_simulated()) return static_cast<int>(fd);
  set_kind(static_cast<int>(fd), Kind::kLocal);
  if (fd < kMostDescriptors) signal_files[fd] = false;
  return static_cast<int>(fd);
}

}  // namespace

SIMBENCH_CALL int pipe2(int ends[2], int flags) noexcept {
  const long result = machine_call(SYS_pipe2, ends, flags);
  if (result < 0) return -1;
  keep_local(ends[0]);
  keep_local(ends[1]);
  return 0;
}

SIMBENCH_CALL int pipe(int ends[2]) noexcept { return pipe2(ends, 0); }

SIMBENCH_CALL int eventfd(unsigned int count, int flags) noexcept {
  return keep_local(machine_call(SYS_eventfd2, count, flags));
}

SIMBENCH_CALL int inotify_init1(int flags) noexcept {
  return keep_local(machine_call(SYS_inotify_init1, flags));
}
SIMBENCH_CALL int inotify_init() noexcept { return inotify_init1(0); }
SIMBENCH_CALL int inotify_add_watch(int fd, const char* path, std::uint32_t mask) noexcept {
  return static_cast<int>(machine_call(SYS_inotify_add_watch, fd, OwnPath(path).text(), mask));
}

// Signals that are blocked stay with the process until they are read here.
SIMBENCH_CALL int signalfd(int fd, const sigset_t* mask, int flags) noexcept {
  const long result = machine_call(SYS_signalfd4, fd, mask, 8, flags);
  if (fd >= 0) return static_cast<int>(result);
  const int made = keep_local(result);
  if (made >= 0 && made < kMostDescriptors) signal_files[made] = is_simulated();
  return made;
}

}  // namespace simbench::shim
