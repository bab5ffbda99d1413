#include "hardware/net/kernel_stamps.h"

#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace simbench::hardware {
namespace {

constexpr unsigned kWithoutNumbers = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_TX_SOFTWARE |
                                     SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_OPT_TSONLY;

bool set_flags(int socket, unsigned flags) {
  return setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof flags) == 0;
}

// What the control messages of a read carry.
struct ControlMessages {
  std::optional<timespec> stamp;
  std::optional<sock_extended_err> error;
};

ControlMessages control_messages(msghdr& header) {
  ControlMessages found;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    const std::size_t size = part->cmsg_len - CMSG_LEN(0);
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMPING &&
        size >= sizeof(timespec)) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      if (stamp.tv_sec != 0 || stamp.tv_nsec != 0) found.stamp = stamp;
    }
    const bool ip = part->cmsg_level == SOL_IP && part->cmsg_type == IP_RECVERR;
    const bool ip6 = part->cmsg_level == SOL_IPV6 && part->cmsg_type == IPV6_RECVERR;
    if ((ip || ip6) && size >= sizeof(sock_extended_err)) {
      sock_extended_err error{};
      std::memcpy(&error, CMSG_DATA(part), sizeof error);
      found.error = error;
    }
  }
  return found;
}

using ControlBuffer = std::array<std::byte, 512>;

// The largest error of a converted stamp: the process may be interrupted between two readings.
constexpr Nanoseconds kStampError = std::chrono::milliseconds(1);

}  // namespace

bool take_transmit_stamps(int socket, TransmitLog& log) {
  bool some = false;
  while (const auto stamp = next_transmit_stamp(socket)) {
    log.stamped(stamp->number, stamp->at);
    some = true;
  }
  return some;
}

bool request_kernel_stamps(int socket) {
  return set_flags(socket, kWithoutNumbers | SOF_TIMESTAMPING_OPT_ID);
}

bool request_receive_stamps(int socket) {
  return set_flags(socket, SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE);
}

void restart_stamp_numbers(int socket) {
  set_flags(socket, kWithoutNumbers);
  set_flags(socket, kWithoutNumbers | SOF_TIMESTAMPING_OPT_ID);
}

std::optional<MonotonicTime> monotonic_of(const timespec& realtime) {
  constexpr int kTries = 4;
  constexpr Nanoseconds kCloseEnough{500};
  const PairedReading reading =
      paired_reading(read_system_clock, monotonic_now, kTries, kCloseEnough);
  const HostTime wall(std::chrono::seconds(realtime.tv_sec) + Nanoseconds(realtime.tv_nsec));
  const MonotonicTime at = reading.at - (reading.reads - wall);
  const MonotonicTime now = monotonic_now();
  if (at > now + kStampError || at < now - kOldestStamp) return std::nullopt;
  return std::min(at, now);
}

ReceivedPiece receive_stamped(int socket, std::span<std::byte> to, sockaddr_storage* from) {
  iovec piece{to.data(), to.size()};
  alignas(cmsghdr) ControlBuffer control;
  msghdr header{};
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  header.msg_name = from;
  header.msg_namelen = from == nullptr ? 0 : sizeof *from;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  ssize_t got = 0;
  do {
    got = recvmsg(socket, &header, MSG_DONTWAIT);
  } while (got < 0 && errno == EINTR);
  if (got < 0) return {.error = errno};
  ReceivedPiece received{.bytes = static_cast<std::size_t>(got),
                         .truncated = (header.msg_flags & MSG_TRUNC) != 0,
                         .received = monotonic_now()};
  if (const auto stamp = control_messages(header).stamp) {
    if (const auto at = monotonic_of(*stamp)) received.received = *at;
  }
  return received;
}

std::optional<TransmitStamp> next_transmit_stamp(int socket) {
  for (;;) {
    alignas(cmsghdr) ControlBuffer control;
    // The stamp comes without data; without room for some, QEMU's user mode answers 0 for ever.
    std::byte data{};
    iovec piece{&data, 1};
    msghdr header{};
    header.msg_iov = &piece;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    if (recvmsg(socket, &header, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) {
      if (errno == EINTR) continue;
      return std::nullopt;
    }
    const ControlMessages found = control_messages(header);
    const bool sent = found.error && found.error->ee_origin == SO_EE_ORIGIN_TIMESTAMPING &&
                      found.error->ee_info == SCM_TSTAMP_SND;
    if (!sent || !found.stamp) continue;
    if (const auto at = monotonic_of(*found.stamp)) {
      return TransmitStamp{.number = found.error->ee_data, .at = *at};
    }
  }
}

void TransmitLog::sent(MessageId id, std::uint32_t number, MonotonicTime called) {
  if (entries_.size() == kKept) entries_.pop_front();
  entries_.push_back({.id = id, .number = number, .called = called, .left = std::nullopt});
}

void TransmitLog::stamped(std::uint32_t number, MonotonicTime at) {
  // The newest first: stamps belong to what was sent just now, and numbers wrap.
  const auto entry = std::find_if(entries_.rbegin(), entries_.rend(),
                                  [number](const Entry& e) { return e.number == number; });
  if (entry == entries_.rend() || entry->left || at < entry->called - kStampError) return;
  entry->left = std::max(at, entry->called);
}

void TransmitLog::forget_numbers() {
  for (Entry& entry : entries_) entry.number.reset();
}

const TransmitLog::Entry* TransmitLog::find(MessageId id) const {
  const auto entry =
      std::lower_bound(entries_.begin(), entries_.end(), id,
                       [](const Entry& e, MessageId wanted) { return e.id < wanted; });
  return entry == entries_.end() || entry->id != id ? nullptr : &*entry;
}

}  // namespace simbench::hardware
