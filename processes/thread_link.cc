#include "processes/thread_link.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace simbench::processes {
namespace {

constexpr std::size_t kControl = CMSG_SPACE(sizeof(int)) + CMSG_SPACE(sizeof(ucred));

// What came beside the request. Descriptors beyond the first are closed.
void read_control(msghdr& message, ChildRequest& request) {
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
       head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level != SOL_SOCKET) continue;
    if (head->cmsg_type == SCM_CREDENTIALS && head->cmsg_len >= CMSG_LEN(sizeof(ucred))) {
      ucred sender{};
      std::memcpy(&sender, CMSG_DATA(head), sizeof sender);
      request.sender = sender.pid;
    }
    if (head->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (head->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int passed = -1;
      std::memcpy(&passed, CMSG_DATA(head) + i * sizeof passed, sizeof passed);
      if (request.passed >= 0) close(std::exchange(request.passed, -1));
      request.passed = passed;
    }
  }
}

bool passes_descriptor(const ChildRequest& request) {
  return request.is_whole && (request.head.call == shim::Call::kNewThread ||
                              request.head.call == shim::Call::kNewProcess);
}

}  // namespace

ThreadLink::ThreadLink(int descriptor, std::chrono::milliseconds patience)
    : descriptor_(descriptor), patience_(patience) {
  const std::chrono::microseconds look = std::min(kLook, patience_);
  const timeval limit{.tv_sec = 0, .tv_usec = look.count()};
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

ThreadLink::~ThreadLink() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ThreadLink::ask_for_sender() {
  const int on = 1;
  asks_for_sender_ = setsockopt(descriptor_, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) == 0;
}

std::optional<ChildRequest> ThreadLink::next(const std::function<bool(Waited)>& goes_on,
                                             const std::function<bool()>& is_asleep) {
  ChildRequest request;
  buffer_.resize(shim::kMostData);
  std::array<iovec, 2> pieces{
      {{&request.head, sizeof request.head}, {buffer_.data(), buffer_.size()}}};
  alignas(cmsghdr) std::array<unsigned char, kControl> control{};
  msghdr message{};
  ssize_t size = 0;
  was_asleep_ = false;
  int seen_asleep = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    message = {};
    message.msg_iov = pieces.data();
    message.msg_iovlen = pieces.size();
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    size = recvmsg(descriptor_, &message, MSG_CMSG_CLOEXEC);
    const int error = size < 0 ? errno : 0;
    if (!goes_on(std::chrono::steady_clock::now() - begin)) return std::nullopt;
    if (error != EINTR && error != EAGAIN) break;
    if (error == EINTR || !is_asleep) continue;
    seen_asleep = is_asleep() ? seen_asleep + 1 : 0;
    was_asleep_ = seen_asleep == 2;
    if (was_asleep_) return std::nullopt;
  }
  if (size <= 0) return std::nullopt;
  const auto whole = static_cast<std::size_t>(size);
  const std::size_t data_size = whole - std::min(whole, sizeof request.head);
  request.is_whole = whole >= sizeof request.head && request.head.size == data_size;
  request.data.assign(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(data_size));
  if (message.msg_controllen > 0) read_control(message, request);
  if (request.passed >= 0 && !passes_descriptor(request)) close(std::exchange(request.passed, -1));
  if (std::exchange(asks_for_sender_, false)) {
    const int off = 0;
    setsockopt(descriptor_, SOL_SOCKET, SO_PASSCRED, &off, sizeof off);
  }
  return request;
}

void ThreadLink::await_request() const {
  pollfd interest{.fd = descriptor_, .events = POLLIN, .revents = 0};
  while (poll(&interest, 1, static_cast<int>(patience_.count())) < 0 && errno == EINTR) {
  }
}

void ThreadLink::reply(std::int64_t value, int error, std::span<const std::byte> data) {
  shim::Reply head{.value = value, .error = error, .size = static_cast<std::uint32_t>(data.size())};
  std::array<iovec, 2> pieces{
      {{&head, sizeof head}, {const_cast<std::byte*>(data.data()), data.size()}}};
  msghdr message{};
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  sendmsg(descriptor_, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace simbench::processes
