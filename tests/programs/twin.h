// What the programs have in common that run twice, on the machine's own kernel and in the simulated
// world: each prints what every call gave, and both must print the same.
//
//   say("bind", bind(fd, any.name(), any.size()));  // bind: 0, or bind: EADDRINUSE
#pragma once

#include <arpa/inet.h>
#include <errno.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace twin {

// A result, or the error of a call that failed.
inline void say(const char* call, long result) {
  if (result >= 0) {
    std::printf("%s: %ld\n", call, result);
  } else {
    std::printf("%s: %s\n", call, strerrorname_np(errno));
  }
  std::fflush(stdout);
}

inline void tell(const char* what, const std::string& value) {
  std::printf("%s: %s\n", what, value.c_str());
  std::fflush(stdout);
}

// An address of either family: "127.0.0.1", "::1", "fe80::1%eth0".
class Name {
 public:
  Name() = default;
  Name(const std::string& host, std::uint16_t port) {
    const std::size_t at = host.find('%');
    const std::string number = host.substr(0, at);
    if (host.find(':') == std::string::npos) {
      auto& in = reinterpret_cast<sockaddr_in&>(place_);
      in.sin_family = AF_INET;
      in.sin_port = htons(port);
      inet_pton(AF_INET, number.c_str(), &in.sin_addr);
      size_ = sizeof in;
      return;
    }
    auto& in = reinterpret_cast<sockaddr_in6&>(place_);
    in.sin6_family = AF_INET6;
    in.sin6_port = htons(port);
    inet_pton(AF_INET6, number.c_str(), &in.sin6_addr);
    if (at != std::string::npos) in.sin6_scope_id = if_nametoindex(host.c_str() + at + 1);
    size_ = sizeof in;
  }
  sockaddr* name() { return reinterpret_cast<sockaddr*>(&place_); }
  const sockaddr* name() const { return reinterpret_cast<const sockaddr*>(&place_); }
  socklen_t size() const { return size_; }
  socklen_t* room() {
    size_ = sizeof place_;
    return &size_;
  }
  std::uint16_t port() const {
    return ntohs(reinterpret_cast<const sockaddr_in&>(place_).sin_port);
  }
  // Ports that the kernel chose are "some".
  std::string text() const {
    if (size_ == 0) return "no name";
    char host[INET6_ADDRSTRLEN] = "";
    const bool is_v6 = place_.ss_family == AF_INET6;
    const auto& in = reinterpret_cast<const sockaddr_in&>(place_);
    const auto& in6 = reinterpret_cast<const sockaddr_in6&>(place_);
    if (place_.ss_family != AF_INET && !is_v6) return "family " + std::to_string(place_.ss_family);
    if (is_v6) {
      inet_ntop(AF_INET6, &in6.sin6_addr, host, sizeof host);
    } else {
      inet_ntop(AF_INET, &in.sin_addr, host, sizeof host);
    }
    std::string text = host;
    if (is_v6 && in6.sin6_scope_id != 0) text += "%" + std::to_string(in6.sin6_scope_id);
    return text + " " + (port() >= 32768 ? "some" : std::to_string(port()));
  }

 private:
  sockaddr_storage place_{};
  socklen_t size_ = 0;
};

inline int bind_to(int fd, const Name& to) { return bind(fd, to.name(), to.size()); }
inline int connect_to(int fd, const Name& to) { return connect(fd, to.name(), to.size()); }
inline int dissolve(int fd) {
  sockaddr nobody{};
  nobody.sa_family = AF_UNSPEC;
  return connect(fd, &nobody, sizeof nobody);
}
inline ssize_t send_to(int fd, const std::string& text, const Name& to, int flags = 0) {
  return sendto(fd, text.data(), text.size(), flags, to.name(), to.size());
}
inline std::string own_name(int fd) {
  Name name;
  return getsockname(fd, name.name(), name.room()) == 0 ? name.text() : strerrorname_np(errno);
}
inline std::string peer_name(int fd) {
  Name name;
  return getpeername(fd, name.name(), name.room()) == 0 ? name.text() : strerrorname_np(errno);
}
inline int set_number(int fd, int level, int option, int value) {
  return setsockopt(fd, level, option, &value, sizeof value);
}
// An option's value, or the error.
inline std::string number_of(int fd, int level, int option) {
  int value = -12345;
  socklen_t size = sizeof value;
  if (getsockopt(fd, level, option, &value, &size) < 0) return strerrorname_np(errno);
  return std::to_string(value);
}

inline std::string events_of(int fd, short asked, int patience_ms = 50) {
  pollfd interest{.fd = fd, .events = asked, .revents = 0};
  const int ready = poll(&interest, 1, patience_ms);
  if (ready < 0) return strerrorname_np(errno);
  std::string text;
  const struct {
    short bit;
    const char* name;
  } kinds[] = {{POLLIN, "IN"},   {POLLPRI, "PRI"},   {POLLOUT, "OUT"},    {POLLERR, "ERR"},
               {POLLHUP, "HUP"}, {POLLNVAL, "NVAL"}, {POLLRDHUP, "RDHUP"}};
  for (const auto& kind : kinds) {
    if ((interest.revents & kind.bit) != 0)
      text += std::string(text.empty() ? "" : " ") + kind.name;
  }
  return text.empty() ? "nothing" : text;
}

// What comes, and from whom; waits for it.
inline std::string received(int fd, int flags = 0, std::size_t room = 70'000) {
  static char bytes[70'000];
  Name from;
  const ssize_t size = recvfrom(fd, bytes, room, flags, from.name(), from.room());
  if (size < 0) return strerrorname_np(errno);
  const std::string text(
      bytes, static_cast<std::size_t>(size) < room ? static_cast<std::size_t>(size) : room);
  return (size > 40 ? std::to_string(size) + " bytes" : "\"" + text + "\"") + " from " +
         from.text();
}

}  // namespace twin
